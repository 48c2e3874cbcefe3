"""Runs and datasets as arrays: what is read, written, shared and refused."""

import gc
import pathlib
import tempfile
import unittest

import numpy as np

import kenaf

THREE_ROWS = "t_s,x_m,note_1\n0,0.5,\n0.01,,2\n0.02,0.7,3\n"


class Files(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name: str, text: str) -> pathlib.Path:
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_columns_are_float64_arrays_and_empty_cells_are_nan(self) -> None:
        run = kenaf.read_run(self.file("run.csv", THREE_ROWS))
        self.assertEqual(list(run), ["t_s", "x_m", "note_1"])
        self.assertEqual((run["x_m"].dtype, run["x_m"].shape), (np.float64, (3,)))
        np.testing.assert_array_equal(run["x_m"], [0.5, np.nan, 0.7])
        self.assertEqual((run.row_count, run.duration_s, run.file), (3, 0.02, "run.csv"))

    def test_arrays_share_the_memory_of_their_run_and_outlive_it(self) -> None:
        run = kenaf.read_run(self.file("run.csv", THREE_ROWS))
        t_s = run["t_s"]
        self.assertFalse(t_s.flags.owndata)
        self.assertTrue(np.shares_memory(t_s, dict(run)["t_s"]))
        del run
        gc.collect()
        np.testing.assert_array_equal(t_s, [0, 0.01, 0.02])

    def test_a_form_that_is_not_the_usual_one_is_named(self) -> None:
        run = kenaf.read_run(self.file("run.csv", "t_s;x_m\n0,0;0,5\n0,01;0,7\n"))
        np.testing.assert_array_equal(run["x_m"], [0.5, 0.7])
        self.assertIn("semicolons", run.reading)

    def test_a_file_that_is_wrong_is_refused_with_its_line(self) -> None:
        for text, words in (("t_s,x_m\n0,1\n0,2\n", r"run\.csv:3"), ("x_m\n1\n", "t_s")):
            with self.assertRaisesRegex(kenaf.InputError, words):
                kenaf.read_run(self.file("run.csv", text))
        with self.assertRaises(ValueError):  # what an InputError is, too
            kenaf.read_run(self.folder / "absent.csv")

    def test_what_is_written_is_read_back_bit_by_bit(self) -> None:
        t_s = np.arange(5) * 0.01
        run = kenaf.Run({"t_s": t_s, "x_m": np.sqrt(t_s), "y_m": [1, np.nan, 3, 4, 5]}, manoeuvre="own", world="flat")
        kenaf.write_run(self.folder / "a.csv", run)
        np.testing.assert_array_equal(kenaf.read_run(self.folder / "a.csv")["x_m"], run["x_m"])

        dataset = kenaf.Dataset([run, run], robot="husky", noise={"x_m": 0.001}, description="two of a kind")
        kenaf.write_runs(self.folder / "data", dataset)
        back = kenaf.read_runs(self.folder / "data")
        self.assertEqual((back.robot, back.source, back.noise), ("husky", "real", {"x_m": 0.001}))
        self.assertEqual([one.file for one in back], ["run-000.csv", "run-001.csv"])
        self.assertEqual((back[1].manoeuvre, back[1].world), ("own", "flat"))
        np.testing.assert_array_equal(back[1]["y_m"], run["y_m"])

    def test_a_folder_that_is_not_empty_is_kept(self) -> None:
        run = kenaf.Run({"t_s": [0.0, 1.0]}, manoeuvre="own")
        self.file("mine.txt", "mine")
        with self.assertRaisesRegex(RuntimeError, "force=True"):
            kenaf.write_runs(self.folder, kenaf.Dataset([run]))
        self.assertEqual([file.name for file in self.folder.iterdir()], ["mine.txt"])

    def test_times_that_do_not_increase_are_not_written(self) -> None:
        with self.assertRaises(ValueError):
            kenaf.write_run(self.folder / "a.csv", {"t_s": [0.0, 0.0]})
        self.assertFalse((self.folder / "a.csv").exists())


class Columns(unittest.TestCase):
    def test_a_run_needs_times_and_columns_of_one_length(self) -> None:
        with self.assertRaisesRegex(ValueError, "t_s"):
            kenaf.Run({"x_m": [1.0]})
        with self.assertRaisesRegex(ValueError, r"x_m \(2,\)"):
            kenaf.Run({"t_s": [0.0], "x_m": [1.0, 2.0]})

    def test_columns_side_by_side(self) -> None:
        run = kenaf.Run({"t_s": [0.0, 1.0], "x_m": [1.0, 2.0], "y_m": [3.0, 4.0]})
        np.testing.assert_array_equal(run.stacked(["y_m", "x_m"]), [[3, 1], [4, 2]])


if __name__ == "__main__":
    unittest.main()

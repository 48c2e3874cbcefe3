"""A diagnosis of simulated runs with a hidden effect, and its report as objects and as a file."""

import json
import math
import pathlib
import tempfile
import unittest

import kenaf

LAG_S = 0.08


def runs_with_lag() -> kenaf.Dataset:
    asked = [
        kenaf.Simulation(manoeuvre, repeat=repeat, values={"drive_lag": LAG_S})
        for manoeuvre in ("speed-steps", "turn-in-place")
        for repeat in range(2)
    ]
    return kenaf.Dataset(kenaf.simulate_all(asked), source="sim", noise=kenaf.noise())


class Diagnosis(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = pathlib.Path(folder.name) / "out"
        cls.shares: list[float] = []
        cls.report = kenaf.diagnose(
            runs_with_lag(), out=cls.out, propose_next=False, progress=lambda doing, share: cls.shares.append(share)
        )

    def test_names_the_hidden_effect_with_its_value(self) -> None:
        self.assertEqual((self.report.verdict, self.report.named), ("named", ["drive_lag"]))
        named = [effect for effect in self.report.effects if effect.is_named]
        self.assertEqual(len(named), 1)
        self.assertIn(LAG_S, named[0].value)  # the 95 % interval, which misses one time in twenty: here it does not
        self.assertEqual((named[0].value.unit, named[0].value.nominal), ("s", 0.0))
        self.assertEqual(self.report.values, {"drive_lag": named[0].value.value})

    def test_tells_where_the_gap_is_and_how_far_it_shrinks(self) -> None:
        stage = self.report.main_stage
        assert stage is not None
        self.assertEqual(stage.name, "command to drive")
        self.assertGreater(stage.explains.value, 0.9)
        self.assertLess(stage.gap.after, stage.gap.before / 5)
        self.assertAlmostEqual(sum(gap.share for gap in stage.channels), 1, delta=0.2)
        self.assertEqual(stage.angle_deg.shape, (len(stage.shown), len(stage.shown)))

    def test_writes_the_files_of_kenaf_gap(self) -> None:
        self.assertEqual(
            sorted(file.name for file in self.out.iterdir()), ["report.html", "report.json", "robot.toml"]
        )
        self.assertEqual((self.out / "robot.toml").read_text(), self.report.robot_toml)
        self.assertEqual((self.out / "report.html").read_text(), self.report.html)

    def test_its_file_reads_back_as_the_same_report(self) -> None:
        back = kenaf.read_report(self.out / "report.json")
        self.assertEqual(back.values, self.report.values)
        self.assertEqual(repr(back.effects), repr(self.report.effects))  # NaN equals itself in text alone
        self.assertIn("drive_lag", str(back))

    def test_its_progress_never_decreases(self) -> None:
        self.assertEqual(self.shares, sorted(self.shares))

    def test_prints_a_screen_of_text(self) -> None:
        self.assertTrue(str(self.report).startswith("NAMED: drive_lag"))


class WrongInput(unittest.TestCase):
    def test_is_refused_with_words(self) -> None:
        with self.assertRaisesRegex(kenaf.InputError, "dataset.toml"):
            kenaf.diagnose("/no/such/folder")
        with self.assertRaisesRegex(ValueError, "drive_lga"):
            kenaf.diagnose(runs_with_lag(), without=["drive_lga"])

    def test_a_report_of_another_kind_is_refused(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "report.json"
            for text in ('{"format": "kenaf-gap-report/1"}', "[]", "no JSON"):
                file.write_text(text)
                with self.subTest(text), self.assertRaises(ValueError):
                    kenaf.read_report(file)

    def test_inputs_are_not_overwritten(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            kenaf.write_runs(folder, runs_with_lag(), force=True)
            with self.assertRaises(RuntimeError):
                kenaf.diagnose(folder, out=folder)


class NullIsNan(unittest.TestCase):
    def test_in_every_number(self) -> None:
        interval = kenaf.Interval._of(None, [None, 1])
        self.assertTrue(math.isnan(interval.value) and math.isnan(interval.low))
        self.assertNotIn(0.5, interval)


if __name__ == "__main__":
    unittest.main()

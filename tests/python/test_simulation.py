"""Simulations: the same as by kenaf-gap, on any number of threads, with numbers changed by name."""

import os
import signal
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import kenaf


class OneRun(unittest.TestCase):
    def test_is_the_run_of_kenaf_gap_bit_by_bit(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                [os.environ["KENAF_BIN_DIR"] + "/kenaf-gap", "simulate", "--manoeuvre", "turn-in-place", "--repeats", "2"]
                + ["--seed", "5", "--effect", "drive_lag:lag_s=0.05", "--out", folder],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            expected = kenaf.read_runs(folder)[1]
        run = kenaf.simulate("turn-in-place", repeat=1, seed=5, values={"drive_lag": 0.05})
        self.assertEqual(list(run), list(expected))
        for name in run:
            np.testing.assert_array_equal(run[name], expected[name], err_msg=name)

    def test_tells_how_the_manoeuvre_ended(self) -> None:
        run = kenaf.simulate("straight")
        self.assertEqual((run.manoeuvre, run.world, run.succeeded, run.gave_up, run.fault), ("straight", "flat", True, False, ""))
        self.assertGreaterEqual(len(run.phase_began_s), 2)

    def test_own_commands_drive_as_far_as_their_speed_says(self) -> None:
        # 0.2 m/s for 2 s; the drive's lag of 0.05 s costs as much at the start as it adds at the end
        commands = kenaf.Commands([0, 0.5, 2.5, 3.5], [[0, 0], [0.2, 0.2], [0, 0], [0, 0]])
        run = kenaf.simulate(commands, noise=0, scatter=0)
        self.assertEqual(run.world, "flat")
        self.assertAlmostEqual(run["track_left_m"][-1], 0.4, delta=0.003)
        self.assertAlmostEqual(run["x_m"][-1] - run["x_m"][0], 0.4, delta=0.004)
        # left faster than right turns to the right: negative yaw
        turn = kenaf.simulate(kenaf.Commands([0, 1], [[0.2, -0.2], [0, 0]]), noise=0, scatter=0)
        self.assertLess(turn["yaw_rad"][-1], -0.3)

    def test_flippers_follow_own_commands(self) -> None:
        up = [0.5, 0.5, -0.2, -0.2]
        run = kenaf.simulate(kenaf.Commands([0, 3], np.zeros((2, 2)), flipper_rad=[up, up]), noise=0)
        self.assertAlmostEqual(run["flipper_fl_rad"][-1], 0.5, delta=0.02)
        self.assertAlmostEqual(run["flipper_rr_rad"][-1], -0.2, delta=0.02)

    def test_a_run_is_replayed_by_its_commands(self) -> None:
        run = kenaf.simulate("arc", noise=0, scatter=0)
        again = kenaf.simulate(run, noise=0)
        self.assertEqual(again.row_count, run.row_count)
        self.assertLess(np.abs(again["x_m"] - run["x_m"]).max(), 1e-3)

    def test_a_number_of_the_description_is_changed_by_name(self) -> None:
        # The turn rate of belts without slip is the speeds' difference over the separation: further apart, slower.
        rate = [
            kenaf.simulate("turn-in-place", noise=0, values={"track.separation_m": m})["gyro_z_radps"].max()
            for m in (0.2, 0.24)
        ]
        self.assertLess(rate[1], rate[0])

    def test_a_robot_with_wheels_is_simulated_too(self) -> None:
        run = kenaf.simulate("straight", robot="husky")
        self.assertTrue(run.succeeded)
        self.assertNotIn("flipper_fl_rad", run)


class ManyRuns(unittest.TestCase):
    asked = [kenaf.Simulation("straight", repeat=k) for k in range(6)]

    def test_are_the_same_on_any_number_of_threads_and_in_order(self) -> None:
        alone, together = kenaf.simulate_all(self.asked, jobs=1), kenaf.simulate_all(self.asked, jobs=3)
        for a, b in zip(alone, together):
            np.testing.assert_array_equal(a["x_m"], b["x_m"])
        self.assertEqual(len({run["x_m"][-1] for run in alone}), len(alone))  # each has its own noise

    def test_keep_only_the_columns_asked_for(self) -> None:
        counts: list[int] = []
        runs = kenaf.simulate_all(self.asked[:2], columns=["x_m", "t_s"], progress=counts.append)
        self.assertEqual(list(runs[0]), ["x_m", "t_s"])
        self.assertEqual(counts[-1], 2)

    def test_end_at_control_c(self) -> None:
        hours = [kenaf.Simulation("random-speeds", repeat=k) for k in range(100000)]

        def interrupt(finished: int) -> None:
            if finished > 0:
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            kenaf.simulate_all(hours, columns=["t_s"], progress=interrupt)

    def test_let_other_threads_run(self) -> None:
        ran = threading.Event()
        thread = threading.Thread(target=ran.set)
        kenaf.simulate_all(self.asked, progress=lambda finished: thread.is_alive() or ran.is_set() or thread.start())
        thread.join()
        self.assertTrue(ran.is_set())

    def test_an_error_of_the_progress_function_ends_them(self) -> None:
        def fail(finished: int) -> None:
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            kenaf.simulate_all(self.asked, progress=fail)


class WrongInput(unittest.TestCase):
    def test_is_refused_with_words(self) -> None:
        for words, arguments in (
            ("drive_lga", {"values": {"drive_lga": 1}}),
            ("out of range", {"values": {"track.friction_along": -1}}),
            ("out of range", {"values": {"drive_lag": float("nan")}}),
            ("another name sets the same", {"values": {"track.separation_m": 0.3, "track.left_center_m[1]": 0.2}}),
            ("track.contact_length_m is -0.03", {"values": {"track.length_m": 0.1}}),
            ("noise: -1", {"noise": -1}),
            ("sample_period_s", {"sample_period_s": 0.0}),
            ("sample period", {"sample_period_s": 0.0105}),
            ("physics", {"physics": {"timestep": 1}}),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                kenaf.simulate("straight", **arguments)

    def test_a_name_that_is_no_manoeuvre_world_or_robot_is_an_input_error(self) -> None:
        for arguments in ({"manoeuvre": "fly"}, {"manoeuvre": "straight", "world": "moon"}, {"manoeuvre": "straight", "robot": "r2d2"}):
            with self.subTest(arguments), self.assertRaises(kenaf.InputError):
                kenaf.simulate(**arguments)

    def test_commands_of_another_shape_are_refused(self) -> None:
        for words, commands in (
            ("t_s", kenaf.Commands([1, 2], np.zeros((2, 2)))),
            ("t_s", kenaf.Commands([0], np.zeros((1, 2)))),
            (r"track_mps: has the shape \(3, 2\)", kenaf.Commands([0, 1], np.zeros((3, 2)))),
            ("track_mps: has a value that is not finite", kenaf.Commands([0, 1], np.full((2, 2), np.inf))),
            (r"flipper_rad: has the shape \(2, 2\)", kenaf.Commands([0, 1], np.zeros((2, 2)), np.zeros((2, 2)))),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                kenaf.simulate(commands)

    def test_what_is_neither_a_name_nor_a_run_is_a_type_error(self) -> None:
        with self.assertRaises(TypeError):
            kenaf.simulate(3)  # type: ignore[arg-type]

    def test_columns_without_times_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "t_s"):
            kenaf.simulate_all([], columns=["x_m"])


class Names(unittest.TestCase):
    def test_list_what_ships(self) -> None:
        self.assertIn("kenaf", kenaf.robots())
        self.assertIn("flat", kenaf.worlds())
        self.assertIn("straight", [manoeuvre.name for manoeuvre in kenaf.manoeuvres()])
        self.assertGreater(kenaf.noise()["track_left_mps"], 0)
        self.assertNotIn("yaw_rad", kenaf.noise(scale=0))  # the encoders still count whole steps

    def test_of_parameters_are_those_of_values(self) -> None:
        # Each parameter at its present value changes no bit of a short run.
        commands = kenaf.Commands([0, 0.2], [[0.1, 0.1], [0, 0]])
        nominal, *changed = kenaf.simulate_all(
            [kenaf.Simulation(commands)]
            + [kenaf.Simulation(commands, values={p.name: p.present}) for p in kenaf.parameters()]
        )
        for parameter, run in zip(kenaf.parameters(), changed):
            np.testing.assert_array_equal(run["x_m"], nominal["x_m"], err_msg=parameter.name)


if __name__ == "__main__":
    unittest.main()

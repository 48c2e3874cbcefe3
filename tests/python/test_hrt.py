"""hrt as a module: a simulated robot is driven, and every error is an exception."""

import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import kenaf
from kenaf import hrt_real, hrt_sim as hrt
from tests.python.relay import Relay


class WithoutRobot(unittest.TestCase):
    def test_a_call_raises_with_the_words_of_hrt_last_error(self) -> None:
        with self.assertRaisesRegex(hrt.NotInitialisedError, "no robot is open") as raised:
            hrt.go_forward(1)
        self.assertEqual(raised.exception.code, -1)
        self.assertIsInstance(raised.exception, hrt.Error)

    def test_both_libraries_are_there_side_by_side(self) -> None:
        self.assertEqual((hrt.library(), hrt_real.library()), ("sim", "real"))
        self.assertEqual(hrt.version(), hrt_real.version())
        self.assertEqual(set(dir(hrt)), set(dir(hrt_real)))

    def test_the_environment_chooses_the_library(self) -> None:
        for chosen, printed in (("", "sim"), ("sim", "sim"), ("real", "real")):
            environment = {**os.environ, **({"KENAF_LIBRARY": chosen} if chosen else {})}
            program = "from kenaf import hrt; print(hrt.library())"
            out = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
            self.assertEqual(out.stdout.strip(), printed, out.stderr)
        wrong = subprocess.run(
            [sys.executable, "-c", "from kenaf import hrt"], env={**os.environ, "KENAF_LIBRARY": "rael"}, capture_output=True, text=True
        )
        self.assertIn('must be "sim" or "real"', wrong.stderr)

    def test_a_variable_that_does_not_exist_is_an_import_error(self) -> None:
        wrong = subprocess.run(
            [sys.executable, "-c", "import kenaf"], env={**os.environ, "KENAF_DATADIR": "/"}, capture_output=True, text=True
        )
        self.assertNotEqual(wrong.returncode, 0)
        self.assertIn("KENAF_DATADIR is not known; did you mean KENAF_DATA_DIR?", wrong.stderr)

    def test_nobody_at_the_relays_address_is_a_link_error(self) -> None:
        with self.assertRaisesRegex(hrt.LinkError, "start kenaf-relayd"):
            hrt.kenaf_init(hrt.Config(relay="127.0.0.1:9", connect_timeout_s=0.05))

    def test_a_configuration_is_checked(self) -> None:
        self.assertEqual(hrt.Config().max_speed_mmps, 200)  # the default that hrt.h states
        with self.assertRaisesRegex(hrt.ArgumentError, "max_speed_mmps"):
            hrt.kenaf_init(hrt.Config(max_speed_mmps=-1))
        with self.assertRaises(TypeError):
            hrt.Config(max_sped_mmps=1)  # type: ignore[call-arg]
        with self.assertRaisesRegex(ValueError, "127 bytes"):
            hrt.Config(relay="x" * 128)


class Driving(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        relay = Relay()
        relay.__enter__()
        cls.addClassCleanup(relay.__exit__)
        cls.config = hrt.Config(relay=relay.address)

    def setUp(self) -> None:
        hrt.kenaf_init(self.config)
        self.addCleanup(hrt.close)

    def test_motions_move_the_robot(self) -> None:
        hrt.go_forward(100)
        hrt.turning(90)
        state = hrt.get_state()
        self.assertAlmostEqual(state.odometry_x_mm, 100, delta=5)
        self.assertAlmostEqual(state.odometry_yaw_deg, 90, delta=1)
        self.assertEqual(state.track_mm.shape, (2,))
        self.assertEqual(state.flipper_deg.shape, (4,))
        self.assertTrue(state.valid & hrt.HAS_ENCODERS)

    def test_a_loop_of_cycles_counts_robot_time(self) -> None:
        hrt.set_tracks(100, 100)
        first = hrt.wait_cycle()
        for _ in range(50):
            state = hrt.wait_cycle()
        self.assertEqual(state.cycle - first.cycle, 50)
        self.assertAlmostEqual(state.time_s - first.time_s, 0.5, delta=1e-6)
        np.testing.assert_array_equal(state.commanded_track_mmps, [100, 100])

    def test_sleep_ends_at_the_cycle_at_which_one_call_would(self) -> None:
        for seconds, slept in ((0.0, 0.0), (0.25, 0.25), (1.005, 1.01)):
            before = hrt.time()
            hrt.sleep(seconds)
            self.assertAlmostEqual(hrt.time() - before, slept, delta=1e-6)
        with self.assertRaises(ValueError):
            hrt.sleep(float("inf"))
        with self.assertRaises(hrt.ArgumentError):
            hrt.sleep(-1)

    def test_flippers_are_waited_for(self) -> None:
        hrt.set_flipper(hrt.ALL_FLIPPERS, 30)
        hrt.wait_flippers(1, 20)
        np.testing.assert_allclose(hrt.get_state().flipper_deg, 30, atol=1.1)
        hrt.set_flippers(0, 0, 0, 0)
        with self.assertRaises(TimeoutError):
            hrt.wait_flippers(1, 0.05)

    def test_a_recording_is_a_run(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "run.csv"
            hrt.record_start(str(file))
            hrt.sleep(0.5)
            hrt.record_stop()
            self.assertAlmostEqual(kenaf.read_run(file).duration_s, 0.5, delta=0.03)

    def test_control_c_stops_a_motion_and_a_sleep(self) -> None:
        for blocks in (lambda: hrt.go_forward(1000000), lambda: hrt.sleep(86400)):
            before = hrt.get_state().cycle

            def interrupt() -> None:
                while hrt.get_state().cycle < before + 5:
                    pass
                os.kill(os.getpid(), signal.SIGINT)

            thread = threading.Thread(target=interrupt)
            thread.start()
            with self.assertRaises(KeyboardInterrupt):
                blocks()
            thread.join()
            hrt.sleep(0.5)
            np.testing.assert_array_equal(hrt.get_state().commanded_track_mmps, [0, 0])

    def test_control_c_stops_a_wait_for_a_picture_of_a_silent_camera(self) -> None:
        hrt.close()
        with socket.create_server(("127.0.0.1", 0)) as silent:
            config = hrt.Config(relay=self.config.relay, camera_server=f"127.0.0.1:{silent.getsockname()[1]}")
            hrt.kenaf_init(config)
            hrt.set_tracks(150, 150)
            before = hrt.get_state().cycle

            def interrupt() -> None:
                while hrt.get_state().cycle < before + 5:
                    pass
                os.kill(os.getpid(), signal.SIGINT)

            thread = threading.Thread(target=interrupt)
            thread.start()
            with self.assertRaises(KeyboardInterrupt):
                hrt.get_picture(timeout_s=60)
            thread.join()
            np.testing.assert_array_equal(hrt.get_state().commanded_track_mmps, [0, 0])
            with self.assertRaisesRegex(hrt.TimeoutError, "no first picture of the first camera within 0.25 s"):
                hrt.get_picture(timeout_s=0.25)
            with self.assertRaises(hrt.ArgumentError):
                hrt.get_picture(timeout_s=61)

    def test_other_threads_run_while_one_blocks(self) -> None:
        thread = threading.Thread(target=hrt.go_forward, args=(100000,))
        thread.start()
        while not hrt.get_state().activity & hrt.MOTION_ACTIVE:
            hrt.sleep(0.01)
        with self.assertRaises(hrt.BusyError):
            hrt.turning(1)
        hrt.close()  # ends the motion with ClosedError, which the thread prints
        thread.join()


class InterruptsOnFirst:
    """Passes datagrams between one program and a relay; sends this process a SIGINT before the first."""

    def __init__(self, relay: str) -> None:
        host, port = relay.rsplit(":", 1)
        self.relay = (host, int(port))
        self.has_interrupted = False

    def __enter__(self) -> "InterruptsOnFirst":
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self.socket.getsockname()[1]}"
        self.thread = threading.Thread(target=self.run)
        self.thread.start()
        return self

    def run(self) -> None:
        program = None
        while True:
            data, sender = self.socket.recvfrom(65536)
            if not data:
                return
            if sender == self.relay:
                if program is not None:
                    self.socket.sendto(data, program)
                continue
            program = sender
            if not self.has_interrupted:
                self.has_interrupted = True
                os.kill(os.getpid(), signal.SIGINT)
            self.socket.sendto(data, self.relay)

    def __exit__(self, *raised: object) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
            end.sendto(b"", self.socket.getsockname())
        self.thread.join()
        self.socket.close()


class Session(unittest.TestCase):
    def test_closes_the_robot_whatever_ends_the_block(self) -> None:
        with Relay() as relay:
            with self.assertRaises(ZeroDivisionError), hrt.Session(hrt.Config(relay=relay.address)):
                raise ZeroDivisionError
            with self.assertRaises(hrt.NotInitialisedError):
                hrt.get_state()
            with hrt.Session(hrt.Config(relay=relay.address)):
                self.assertGreaterEqual(hrt.time(), 0)

    def test_an_opening_that_control_c_has_met_leaves_no_robot_open(self) -> None:
        with Relay() as relay, InterruptsOnFirst(relay.address) as between:
            with self.assertRaises(KeyboardInterrupt), hrt.Session(hrt.Config(relay=between.address)):
                self.fail("the block was entered")
            self.assertTrue(between.has_interrupted)
            with self.assertRaises(hrt.NotInitialisedError):
                hrt.get_state()
            with hrt.Session(hrt.Config(relay=relay.address)):
                self.assertGreaterEqual(hrt.time(), 0)


if __name__ == "__main__":
    unittest.main()

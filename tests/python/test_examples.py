"""Each example runs, and prints what physics and statistics say."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

from tests.python.relay import Relay

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"


def run(name: str, *arguments: str, **environment: str) -> str:
    out = subprocess.run(
        [sys.executable, str(EXAMPLES / name), *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
    )
    if out.returncode != 0:
        raise AssertionError(f"{name} ended with {out.returncode}: {out.stdout}{out.stderr}")
    return out.stdout


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"-?\d+\.\d+|-?\d+", text)]


class Examples(unittest.TestCase):
    def test_the_square_closes(self) -> None:
        with Relay() as relay:
            x_mm, y_mm = numbers(run("square.py", KENAF_RELAY=relay.address))
        self.assertLess(abs(x_mm), 10)
        self.assertLess(abs(y_mm), 10)

    def test_the_square_without_a_relay_ends_with_words(self) -> None:
        with self.assertRaisesRegex(AssertionError, "ended with 1: square: no relay at 127.0.0.1:9"):
            run("square.py", KENAF_RELAY="127.0.0.1:9", KENAF_CONNECT_TIMEOUT_S="0.05")

    def test_arguments_that_an_example_does_not_take_are_refused(self) -> None:
        for name, arguments, words in (
            ("square.py", ["--help-me"], "unrecognized arguments: --help-me"),
            ("frequency_response.py", ["2"], "unrecognized arguments: 2"),
            ("diagnose.py", ["real", "sim"], "unrecognized arguments: sim"),
            ("fit_parameters.py", ["real", "sim"], "unrecognized arguments: sim"),
            ("success_rate.py", ["step-100", "0"], "'0' must be a whole number from 1 to 100000"),
            ("success_rate.py", ["step-100", "many"], "'many' must be a whole number from 1 to 100000"),
        ):
            with self.subTest(name), self.assertRaisesRegex(AssertionError, f"{name} ended with 2: (.|\n)*{words}"):
                run(name, *arguments)

    def test_the_frequency_response_has_the_described_time_constant(self) -> None:
        for line in run("frequency_response.py").splitlines():
            frequency_hz, gain, phase_deg, time_constant_s = numbers(line)
            self.assertAlmostEqual(time_constant_s, 0.05, delta=0.003)  # share/robots/kenaf.toml
            self.assertAlmostEqual(gain, (1 + (2 * 3.14159 * frequency_hz * 0.05) ** 2) ** -0.5, delta=0.01)

    def test_a_slippery_step_is_climbed_less_often(self) -> None:
        percent, of, *_ = numbers(run("success_rate.py", "step-200-flippers", "12").replace("step-200-flippers", ""))
        self.assertEqual(of, 12)
        self.assertTrue(0 < percent < 100)

    def test_the_fit_finds_the_numbers_that_played_the_robot(self) -> None:
        for line in run("fit_parameters.py").splitlines()[-2:]:
            value, error = numbers(line)[-2:]
            truth = 0.06 if line.startswith("drive_lag") else 0.21
            self.assertAlmostEqual(value, truth, delta=4 * error + 1e-4)

    def test_the_diagnosis_names_the_lag_and_the_corrected_robot_drives_as_the_real_one(self) -> None:
        lines = run("diagnose.py").splitlines()
        self.assertEqual(lines[0], "named")
        self.assertAlmostEqual(numbers(lines[1])[0], 0.05, delta=0.003)
        described_mm, corrected_mm = numbers(lines[-2])[-1], numbers(lines[-1])[-1]
        self.assertLess(corrected_mm, described_mm / 5)


if __name__ == "__main__":
    unittest.main()

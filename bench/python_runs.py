#!/usr/bin/env python3
"""Simulations from Python against the same ones by kenaf-gap simulate, which writes them to disk, in turns.

    PYTHONPATH=build/release/python bench/python_runs.py build/release/bin/kenaf-gap [PAIRS]"""

import statistics
import subprocess
import sys
import tempfile
import time

import kenaf

MANOEUVRE, COUNT = "step-200-flippers", 40


def by_python() -> None:
    kenaf.simulate_all([kenaf.Simulation(MANOEUVRE, repeat=k) for k in range(COUNT)])


def by_program() -> None:
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["simulate", "--manoeuvre", MANOEUVRE, "--repeats", str(COUNT), "--out", folder]
        subprocess.run([sys.argv[1], *arguments], check=True, stdout=subprocess.DEVNULL)


def seconds(call) -> float:
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


pairs = [(seconds(by_python), seconds(by_program)) for _ in range(int(sys.argv[2]) if len(sys.argv) > 2 else 5)]
python_s, program_s = (statistics.median(times) for times in zip(*pairs))
ratio = statistics.median(a / b for a, b in pairs)
print(f"{COUNT} runs of {MANOEUVRE}: Python {python_s:.2f} s, kenaf-gap {program_s:.2f} s, ratio {ratio:.3f} of {len(pairs)} pairs")

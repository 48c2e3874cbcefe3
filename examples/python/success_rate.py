#!/usr/bin/env python3
"""How often does a manoeuvre succeed if the robot is placed by hand and the ground's friction is uncertain?

Simulates it on all cores, each time from another start and with another friction, and prints the share of successes with
its 95 % interval (Wilson 1927)."""

import argparse

import numpy as np

import kenaf


def count_from(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 100000:
        raise argparse.ArgumentTypeError(f"'{text}' must be a whole number from 1 to 100000")
    return int(text)


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("manoeuvre", nargs="?", default="step-200-flippers")
parser.add_argument("count", nargs="?", type=count_from, default=40, help="of drives; from 1 to 100000")
arguments = parser.parse_args()
manoeuvre, count = arguments.manoeuvre, arguments.count
friction = np.random.default_rng(1).uniform(0.4, 1.0, count)
runs = kenaf.simulate_all(
    [
        kenaf.Simulation(manoeuvre, repeat=k, scatter=2, values={"friction_along": mu, "friction_across": mu})
        for k, mu in enumerate(friction)
    ],
    columns=["t_s", "x_m"],
)

n, p, z = len(runs), np.mean([bool(run.succeeded) for run in runs]), 1.96
middle, half = p + z**2 / (2 * n), z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
low, high = (middle - half) / (1 + z**2 / n), (middle + half) / (1 + z**2 / n)
print(f"{manoeuvre}: {p:.0%} of {n} succeed (95 % interval {low:.0%} to {high:.0%})")
for kind, chosen in (("successes", True), ("failures", False)):
    of_kind = [mu for mu, run in zip(friction, runs) if run.succeeded is chosen]
    if of_kind:
        print(f"  {kind}: friction {min(of_kind):.2f} to {max(of_kind):.2f} of the described one")

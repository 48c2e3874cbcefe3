#!/usr/bin/env python3
"""How often does a manoeuvre succeed if the robot is placed by hand and the ground's friction is uncertain?

Simulates it on all cores, each time from another start and with another friction, and prints the share of successes with
its 95 % interval (Wilson 1927). `success_rate.py [MANOEUVRE [COUNT]]`"""

import sys

import numpy as np

import kenaf

manoeuvre = sys.argv[1] if len(sys.argv) > 1 else "step-200-flippers"
count = int(sys.argv[2]) if len(sys.argv) > 2 else 40
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

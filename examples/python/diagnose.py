#!/usr/bin/env python3
"""Finds what differs between a robot and its simulation, and drives the corrected one.

Without an argument a simulation plays the robot, with another time step and drives that lag."""

import argparse

import kenaf

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("folder", nargs="?", help="a dataset of your own")
folder = parser.parse_args().folder
if folder:
    dataset = kenaf.read_runs(folder)
else:
    other = {"time_step_s": 0.0005, "solver_iterations": 20}
    asked = [
        kenaf.Simulation(manoeuvre, repeat=repeat, values={"drive_lag": 0.05}, physics=other)
        for manoeuvre in ("straight", "turn-in-place")
        for repeat in range(2)
    ]
    dataset = kenaf.Dataset(kenaf.simulate_all(asked), noise=kenaf.noise())

report = kenaf.diagnose(dataset, propose_next=False)
print(report.verdict)
for effect in report.effects:
    if effect.is_named:
        value = effect.value
        print(f"  {effect.name} = {value.value:.4f} {value.unit} ({value.low:.4f} to {value.high:.4f})")
        print(f"  explains {effect.explains:.0%} of its stage's gap on runs held out")

# The corrected robot does what the real one did.
run = dataset[0]
for name, values in (("as described", {}), ("corrected", report.values)):
    simulated = kenaf.simulate(run, robot=dataset.robot, values=values, noise=0)
    rows = min(run.row_count, simulated.row_count)
    gap_m = abs(simulated["track_left_m"][:rows] - run["track_left_m"][:rows]).max()
    print(f"{name}: the left track's travel is up to {gap_m * 1000:.1f} mm off")

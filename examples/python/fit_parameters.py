#!/usr/bin/env python3
"""Fits two numbers of the simulated robot to recorded runs by Gauss-Newton, with all simulations on all cores.

Without an argument a simulation plays the robot: its drives lag, and its tracks are further apart than described."""

import argparse

import numpy as np
import numpy.typing as npt

import kenaf

NAMES = ["drive_lag", "track.separation_m"]
STEPS = np.array([0.005, 0.002])  # of finite differences
CHANNELS = ["track_left_mps", "track_right_mps", "yaw_rad"]
RESTING_ROWS = 50  # in which the robot stands before it drives
Vector = npt.NDArray[np.float64]

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("folder", nargs="?", help="a dataset of your own")
folder = parser.parse_args().folder
if folder:
    recorded = list(kenaf.read_runs(folder))
else:
    truth = {"drive_lag": 0.06, "track.separation_m": 0.21}
    recorded = [kenaf.simulate(name, values=truth, seed=7) for name in ("speed-steps", "turn-in-place")]


def residuals_at(points: list[Vector]) -> list[Vector]:
    """Returns recorded less simulated channels of all runs, for each point, in units of the channels' noise."""
    sigma = np.array([kenaf.noise()[channel] for channel in CHANNELS])
    runs = kenaf.simulate_all(
        [kenaf.Simulation(run, values=dict(zip(NAMES, point)), noise=0) for point in points for run in recorded],
        columns=["t_s", *CHANNELS],
    )
    parts = []
    for k, run in enumerate(runs):
        real = recorded[k % len(recorded)]
        rows = min(run.row_count, real.row_count)
        residual = real.stacked(CHANNELS)[:rows] - run.stacked(CHANNELS)[:rows]
        heading = np.angle(np.exp(1j * residual[:, -1]))  # wraps
        residual[:, -1] = heading - heading[:RESTING_ROWS].mean()  # a replay starts at the first row, noise included
        parts.append((residual / sigma).ravel())
    return [np.concatenate(parts[i : i + len(recorded)]) for i in range(0, len(parts), len(recorded))]


point = np.array([0.02, 0.2])
for iteration in range(5):
    here, *beside = residuals_at([point, *(point + np.diag(STEPS))])
    jacobian = np.column_stack([(there - here) / step for there, step in zip(beside, STEPS)])
    measured = np.isfinite(here)  # a slower sensor leaves cells empty
    change, *_ = np.linalg.lstsq(jacobian[measured], -here[measured], rcond=None)
    point = point + change
    print(f"{iteration}: rms {np.sqrt(np.mean(here[measured] ** 2)):.3f} of the noise")

covariance = np.linalg.inv(jacobian[measured].T @ jacobian[measured])
for name, value, error in zip(NAMES, point, np.sqrt(np.diag(covariance))):
    print(f"{name} = {value:.5f}, standard error {error:.5f}")

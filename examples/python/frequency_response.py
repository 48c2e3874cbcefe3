#!/usr/bin/env python3
"""Identifies the drives' time constant from their response to a sum of sines, as one would on the robot.

A drive that closes its speed loop within T answers a sine of frequency f with gain 1 / sqrt(1 + (2 pi f T)^2) and phase
-atan(2 pi f T)."""

import argparse

import numpy as np

import kenaf

argparse.ArgumentParser(description=__doc__).parse_args()  # there are no arguments

PERIOD_S, SAMPLE_S = 10.0, 0.01
FREQUENCIES_HZ = np.array([0.2, 0.5, 1.1, 1.9])  # whole numbers of periods in PERIOD_S

t_s = np.arange(0, 2 * PERIOD_S, SAMPLE_S)
phases = np.array([0.0, 2.0, 4.0, 1.0])  # keep the peaks apart
speed_mps = 0.15 + 0.03 * np.sin(2 * np.pi * FREQUENCIES_HZ * t_s[:, None] + phases).sum(axis=1)
run = kenaf.simulate(kenaf.Commands(t_s, np.column_stack([speed_mps, speed_mps])), scatter=0)

# The first period settles. A command holds for a sample, which adds half a sample to what the drive seems to take.
rows = slice(len(t_s) // 2 - 1, len(t_s) - 1)
waves = np.exp(-2j * np.pi * FREQUENCIES_HZ * run["t_s"][rows, None])
response = (run["track_left_mps"][rows] @ waves) / (run["cmd_track_left_mps"][rows] @ waves)
time_constant_s = np.tan(-np.angle(response)) / (2 * np.pi * FREQUENCIES_HZ) - SAMPLE_S / 2
for f, h, T in zip(FREQUENCIES_HZ, response, time_constant_s):
    print(f"{f:.1f} Hz: gain {abs(h):.3f}, phase {np.angle(h, deg=True):5.1f} degrees, time constant {T:.3f} s")

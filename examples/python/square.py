#!/usr/bin/env python3
"""Drives a square of 100 mm sides, turning left, in simulation or, with KENAF_LIBRARY=real, on the robot.

Start `kenaf-relayd --embedded` before."""

import argparse

from kenaf import hrt

argparse.ArgumentParser(description=__doc__).parse_args()  # there are no arguments

try:
    with hrt.Session():
        for side in range(4):
            hrt.go_forward(100)  # millimetres
            hrt.turning(90)  # degrees
        state = hrt.get_state()
except hrt.Error as error:
    raise SystemExit(f"square: {error}")

print(f"{hrt.library()}: back at x {state.odometry_x_mm:.1f} mm, y {state.odometry_y_mm:.1f} mm by dead reckoning")

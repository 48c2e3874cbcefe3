#!/usr/bin/env bash
# By how much a recorded path does not close, by the simulator's ground truth: the first against the last row that has a pose.
#
#   scripts/closing-error.sh RUN.csv     prints "the square closed within 0.2 mm and 0.15 degrees"
#
# Exit status 0: within 10 mm and 2 degrees; 1: not, or no row has a pose.
exec awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  $column["x_m"] != "" {
    x = $column["x_m"]; y = $column["y_m"]; yaw = $column["yaw_rad"]
    if (!seen++) { x0 = x; y0 = y; yaw0 = yaw }
  }
  END {
    if (!seen) { print "the record holds no pose"; exit 1 }
    millimetres = 1000 * sqrt((x - x0) ^ 2 + (y - y0) ^ 2)
    degrees = atan2(sin(yaw - yaw0), cos(yaw - yaw0)) * 180 / atan2(0, -1)
    if (degrees < 0) degrees = -degrees
    printf "the square closed within %.1f mm and %.2f degrees\n", millimetres, degrees
    exit !(millimetres <= 10 && degrees <= 2)
  }' "$1"

#!/bin/sh
# Sets up the interfaces of a network namespace of its own, then becomes the command: bus-up.sh COMMAND [ARG...]
# An MTU of 16 is one struct can_frame: classic CAN, no CAN FD, as on the robot.
set -e
caller_path=$PATH
PATH=$PATH:/usr/sbin:/sbin
ip link set lo up
for bus in vcan0 vcan1; do
  ip link add "$bus" type vcan
  ip link set "$bus" mtu 16 up
done
PATH=$caller_path
exec "$@"

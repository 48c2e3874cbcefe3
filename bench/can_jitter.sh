#!/usr/bin/env bash
# SYNC and the commands after it while all cores are busy with something else, without real time and with it. On a CAN
# interface vcan0, as root:
#
#   scripts/with-vcan.sh --timeout 1500 bench/can_jitter.sh build/release/bin [CYCLES]
#
# The load are processes of `stress`, four that compute and one that writes memory for each core, as urgent as the program
# (nice 0), and more urgent (nice -15). The drives and candump are not what is measured, so they run before everything
# else, by SCHED_FIFO. The program is can_loop. Without load an emulated machine shows nothing: its clock follows the
# machine's around it while its processor rests.
set -euo pipefail
bin=$(realpath "$1") cycles=${2:-2000}
share=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../share/robots
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$work"' EXIT
for tool in chrt stress candump; do
  command -v "$tool" >/dev/null || { echo "can_jitter: $tool is not installed" >&2; exit 2; }
done

cp "$share/kenaf.toml" "$work/usual.toml"
sed 's/^\[can\]$/&\nrealtime_priority = 50\nlock_memory = true/' "$share/kenaf.toml" >"$work/real-time.toml"

measure() {  # ROBOT NICENESS
  echo "== $1, load at nice $2"
  nice -n "$2" stress --cpu $((4 * $(nproc))) --vm "$(nproc)" --vm-bytes 16M >/dev/null & local load=$!
  chrt -f 95 candump -L vcan0 >"$work/bus.log" & local listener=$!
  chrt -f 90 "$bin/kenaf-candrives" --interface vcan0 --ideal >"$work/drives.log" 2>&1 & local drives=$!
  for _ in $(seq 100); do grep -q 'nodes on vcan0' "$work/drives.log" && break; sleep 0.1; done
  "$bin/can_loop" --no-drives --robot "$work/$1.toml" --cycles "$cycles" || echo "can_jitter: the robot was lost"
  kill "$drives" "$listener" "$load"
  wait "$drives" "$listener" "$load" 2>/dev/null || true
  # from the first command to move on: while it opens, the library waits for SDO answers between its commands
  awk '$3 ~ /^201#0F00/ && $3 !~ /^201#0F0000000000/ { moves = 1 } moves' "$work/bus.log" >"$work/driving.log"
  "$bin/kenaf-canlog" --figures --robot "$work/$1.toml" "$work/driving.log" | grep -E '^(SYNC|commands|late)' || true
}

for niceness in 0 -15; do
  for robot in usual real-time; do measure "$robot" "$niceness"; done
done

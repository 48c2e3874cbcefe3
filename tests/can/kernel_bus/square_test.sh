#!/usr/bin/env bash
# One object file, two libraries, one path: square_test.sh WITH_VCAN BIN_DIR ROBOT GAUGE_MM TIME_STEP_S [PAIR]
#
# PAIR: front or rear: the robot has these flippers alone.
# TIME_STEP_S: of the physics behind the drives; an emulated machine may be too slow for the default, 0.001.
#
# The square example over libkenaf_sim, relay and world server; and over libkenaf_real, SocketCAN and kenaf-candrives, whose
# drives turn the tracks of the same physics.
#
# 1. Both end well.  2. The two paths agree within 5 mm and 1 degree.  3. What was on the bus, from the first frame to the last,
# keeps the standards' rules, and fills less than half of 500 kbit/s.
set -uo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
. "$here/waiting.sh"
with_vcan=$1 bin=$2
export KENAF_ROBOT=$3 KENAF_TRACK_GAUGE_MM=$4 TIME_STEP_S=$5
class=USARBot.$KENAF_ROBOT
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
fail() { echo "square_test: $*" >&2; exit 1; }

# What the machine reads and writes.
mkdir "$work/bus"
if [ $# -gt 5 ]; then
  other=$([ "$6" = front ] && echo rear || echo front)
  sed "s/^\[flipper\]\$/&\npairs = \"$6\"/; /^${other}_\(left\|right\) = /d" "$here/../../../share/robots/$3.toml" >"$work/bus/$6.toml"
  [ "$(grep -cE '^(pairs|(front|rear)_(left|right)) = ' "$work/bus/$6.toml")" = 3 ] || fail "no robot with a $6 pair"
  KENAF_ROBOT=$work/bus/$6.toml
fi

"$bin/kenaf-relayd" --embedded --robot "$KENAF_ROBOT" --class "$class" --view off --cameras off --listen 127.0.0.1:0 --port-file "$work/port" >"$work/relay.log" 2>&1 &
wait_until 20 [ -s "$work/port" ]
KENAF_RELAY="127.0.0.1:$(cat "$work/port")" KENAF_RECORD="$work/sim.csv" "$bin/square_sim" || fail "1: over libkenaf_sim"

# candump writes each frame on its own, which into a folder of this machine's costs an emulated one more than the frame does.
cat >"$work/on_bus.sh" <<'END'
. "$1/waiting.sh"
results=$PWD; shift
cd "$(mktemp -d)" || exit 1
candump -L vcan0 >bus.log & listener=$!
"$1/kenaf-candrives" --interface vcan0 --robot "$KENAF_ROBOT" --time-step "$TIME_STEP_S" --log real.csv >drives.log 2>&1 & drives=$!
wait_until 30 holds drives.log 'nodes on vcan0'
KENAF_CAN_INTERFACE=vcan0 KENAF_CAN_TIMEOUT_S=30 "$1/square_real"; status=$?
pause 1
kill "$drives"; wait "$drives"
kill "$listener"; wait "$listener"
cp bus.log drives.log real.csv "$results"
exit "$status"
END
cd "$work/bus" || exit 1
"$with_vcan" --timeout 800 --writable . bash "$work/on_bus.sh" "$here" "$bin" || { cat drives.log; fail "1: over libkenaf_real"; }
cat drives.log

"$bin/compare_paths" "$work/sim.csv" real.csv 5 1 || fail "2: the paths differ by more than 5 mm and 1 degree"
"$bin/kenaf-canlog" --robot "$KENAF_ROBOT" --check --figures bus.log || fail "3: kenaf-canlog"

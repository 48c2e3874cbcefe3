#!/usr/bin/env bash
# On the bus: robots of all shapes over libkenaf_real and kenaf-candrives: robots_test.sh BIN_DIR ROBOTS_DIR
#
# 1. Each shipped description with a [can] drives a short way.
# 2. Beside devices that its description does not name: all of Kenaf's nodes are on the bus, the description has its tracks
# alone. No frame is sent to the flippers' drives, and none of them becomes enabled.
# 3. Drives that have node guarding alone: the library asks them by remote frames, they answer with the toggle bit, and what was
# on the bus keeps the standards' rules.
set -uo pipefail
. "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/waiting.sh"
bin=$(realpath "$1") robots=$(realpath "$2")
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { cat drives.log; echo "robots_test: $*" >&2; exit 1; }
export KENAF_CONFIG='' KENAF_CAN_INTERFACE=vcan0 KENAF_CAN_TIMEOUT_S=30

# drive ON_BUS DESCRIPTION GAUGE_MM [OPTION_OF_DRIVES...]
drive() {
  "$bin/kenaf-candrives" --interface vcan0 --ideal --robot "$1" "${@:4}" >drives.log 2>&1 & local drives=$!
  wait_until 30 holds drives.log 'nodes on vcan0'
  KENAF_ROBOT=$2 KENAF_TRACK_GAUGE_MM=$3 "$bin/short_drive" || fail "$2 does not drive"
  kill "$drives"; wait "$drives"
}
# In the mean of the wheels, in millimetres: left_center_m of [track] and [[wheel]] has half of it as y.
gauge_of() { awk -F'[][,]' '/^left_center_m/ { sum += 2000 * $3; n++ } END { print sum / n }' "$1"; }

tested=0
for robot in "$robots"/*.toml; do
  grep -q '^\[can\]' "$robot" || continue
  drive "$robot" "$robot" "$(gauge_of "$robot")"
  echo "robots_test: $(basename "$robot" .toml) drives: $(grep -c 'operation enabled' drives.log) drives"
  tested=$((tested + 1))
done
[ "$tested" -ge 9 ] || fail "1: only $tested descriptions"

awk '/^\[/ { skip = /^\[(flipper|servo|can\.flipper)\]/ } !skip { print }' "$robots/kenaf.toml" >bare.toml
candump -L vcan0 >bus.log & listener=$!
drive "$robots/kenaf.toml" "$PWD/bare.toml" 200
kill "$listener"; wait "$listener" 2>/dev/null
holds bus.log 'vcan0 201#' || fail "2: candump heard nothing"
# NMT for nodes 3 to 6, SDO requests and RPDOs to them
grep -E 'vcan0 (000#..0[3-6]|[2345]0[3-6]#|60[3-6]#)' bus.log && fail "2: the frames above were sent to drives of others"
grep 'flipper.*operation enabled' drives.log && fail "2: a flipper's drive was enabled"
echo "robots_test: beside four drives of others: nothing was sent to them"

sed 's/^\[can\]$/&\nevent_timer = false/; s/^\[can\.\(track\|flipper\)\]$/&\ndevice = "node-guarding"/' "$robots/kenaf.toml" >guarding.toml
[ "$(grep -c -e '^event_timer' -e '^device = "node-guarding"' guarding.toml)" = 3 ] || fail "3: no robot with node guarding"
quirks=()
for node in 1 2 3 4 5 6; do quirks+=(--fault "node $node node guarding only"); done
candump -L vcan0 >guarding.log & listener=$!
drive "$PWD/guarding.toml" "$PWD/guarding.toml" 200 "${quirks[@]}"
kill "$listener"; wait "$listener" 2>/dev/null
for node in 1 2 3 4 5 6; do
  for frame in "70$node#R" "70$node#05" "70$node#85"; do holds guarding.log " vcan0 $frame" || fail "3: candump heard no $frame"; done
done
# 0x1016 and 0x1017 of the drives
grep -E 'vcan0 60[1-6]#2[3B]1[67]10' guarding.log && fail "3: the heartbeats above were written to drives that have none"
"$bin/kenaf-canlog" --robot "$PWD/guarding.toml" --check guarding.log || fail "3: kenaf-canlog"
echo "robots_test: six drives with node guarding alone drive"

#!/usr/bin/env bash
# On the bus: what a program linked with libkenaf_real says of a bus that is not as it must be.
#
#   real_library_test.sh SQUARE_REAL
#
# Each time, hrt_kenaf_init fails, and names: 1. an interface that does not exist; 2. one that is not for CAN; 3. one that
# is down; 4. all nodes where nobody is there; 5. only the ones that are missing; 6. that the bus is off; 7. another program
# that has the robot already. Nothing but orders to start is sent.
set -uo pipefail
square=$1
work=$(mktemp -d)
trap 'rm -rf "$work"; kill $(jobs -p) 2>/dev/null' EXIT
cd "$work" || exit 1
fail() { echo "real_library_test: $*" >&2; exit 1; }
export KENAF_CAN_TIMEOUT_S=1

# expect CLAIM INTERFACE WORDS...: the program fails, and says each of the words.
expect() {
  local claim=$1 words status=0; shift
  KENAF_CAN_INTERFACE=$1 timeout 100 "$square" >out 2>&1 || status=$?; shift
  cat out
  [ "$status" = 1 ] || fail "$claim: exit status $status, not 1"
  for words in "$@"; do grep -qF -- "$words" out || fail "$claim: it does not say '$words'"; done
}
# Plays frames over and over on vcan0, each 10 ms after the one before, until stopped; returns once they are heard.
play() {
  printf '(0.000000) vcan0 %s\n' "$@" >frames
  canplayer -l i -t -g 10 -I frames & player=$!
  timeout 30 candump -n $# vcan0,0:0,#FFFFFFFF >heard || fail "nothing is heard of canplayer"
}
stop() { kill "$player"; wait "$player" 2>/dev/null; true; }
# The message of a node that has started (CiA 301: identifier 0x700 + node, one byte, 0), of the nodes named.
play_starts() { local frames=("${@/%/#00}"); play "${frames[@]/#/70}"; }

expect 1 vcan7 HRT_E_DEVICE "no network interface 'vcan7'"
expect 2 lo HRT_E_DEVICE "'lo' is not a CAN interface"

ip link set vcan0 down
expect 3 vcan0 HRT_E_DEVICE "'vcan0' is down" "ip link set vcan0 up"
ip link set vcan0 up

candump -L vcan0 >sent & watching=$!
expect 4 vcan0 HRT_E_DEVICE "on vcan0 these nodes did not start" "track left (node 1)" "track right (node 2)" \
  "flipper front left (node 3)" "flipper front right (node 4)" "flipper rear left (node 5)" \
  "flipper rear right (node 6)" "inclinometer (node 7)" "gyro (node 8)"
kill "$watching"; wait "$watching" 2>/dev/null
# 0x000, "reset communication" (0x82), node; and the master's own heartbeat, for whoever else comes
grep -vE ' vcan0 (000#820[1-8]|77F#05)$' sent && fail "4: it has sent the frames above"
[ -s sent ] || fail "4: candump heard nothing at all"

export KENAF_CAN_TIMEOUT_S=3
play_starts 1 2 3 4 6 8
expect 5 vcan0 HRT_E_DEVICE ": flipper rear left (node 5), inclinometer (node 7);"
stop

# An error frame, as a driver gives it to those who ask: CAN_ERR_FLAG with CAN_ERR_BUSOFF (<linux/can/error.h>).
play 20000040#0000000000000000
expect 6 vcan0 HRT_E_LINK "bus off"
stop

# The heartbeat of a master, node 127.
play 77F#05
expect 7 vcan0 HRT_E_REFUSED "another program controls the robot: the heartbeat of node 127"
stop

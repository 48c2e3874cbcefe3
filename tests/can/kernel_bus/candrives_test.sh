#!/usr/bin/env bash
# On the bus: kenaf-candrives answers byte by byte as CiA 301 and CiA 402 have it, its faults come from its standard input,
# and it outlives a bus that goes down.
#
#   candrives_test.sh KENAF_CANDRIVES
#
# Each claim is a frame that is sent and the frames that must follow, from candump, and no other. Statuswords: 0x0250 switch on
# disabled, 0x0231 ready to switch on, 0x0233 switched on, 0x0237 operation enabled, 0x0217 quick stop active, 0x0218 fault;
# + 0x0400 target reached, + 0x1000 (in profile velocity) stands still.
set -uo pipefail
. "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/waiting.sh"
candrives=$1
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "candrives_test: $*" >&2; cat out errors >&2; exit 1; }

# have_heard COUNT: heard is what candump wrote into the log, a frame each, and they are so many or more.
have_heard() { mapfile -t heard <log; heard=("${heard[@]##* vcan0 }"); [ ${#heard[@]} -ge "$1" ]; }
# expect CLAIM FRAME...: these are the next frames on the bus, and no others.
seen=0
expect() {
  local claim=$1 got; shift
  wait_until 3 have_heard $((seen + $#))
  got="${heard[*]:seen}"
  [ "$got" = "$*" ] || fail "$claim: expected $*, heard $got"
  seen=$((seen + $#))
}
# ask CLAIM FRAME ANSWER...
ask() { cansend vcan0 "$2" || fail "$1: cansend"; expect "$@"; }
either_holds() { holds out "$1" || holds errors "$1"; }
said() { wait_until 3 either_holds "$1" || fail "it does not say '$1'"; }

: >log; : >out; : >errors
listen() {
  candump -L vcan0 >>log 2>/dev/null & listener=$!
  while ! holds log "7FF#$1"; do cansend vcan0 "7FF#$1"; pause 0.05; done
  pause 0.2
  have_heard 1; seen=${#heard[@]}
}
listen 01
mkfifo input
"$candrives" --interface vcan0 --ideal <input >out 2>errors & server=$!
exec 3>input

expect "boot-up" 701#00 702#00 703#00 704#00 705#00 706#00 707#00 708#00
said "8 nodes on vcan0: robot kenaf with ideal motors"

ask "SDO: device type, a servo drive of profile 402" 601#4000100000000000 581#4300100092010200
ask "SDO: no such object" 601#4000300000000000 581#8000300000000206
ask "SDO: name, 33 bytes in segments" 601#4008100000000000 581#4108100021000000
ask "SDO: its first segment, 'Kenaf s'" 601#6000000000000000 581#004B656E61662073
ask "the inclinometer: profile 410, two axes" 607#4000100000000000 587#430010009A010200

ask "NMT: start, and the statusword's PDO" 000#0101 181#5002
ask "profile velocity" 601#2F60600003000000 581#6060600000000000
ask "shutdown" 201#0600 181#3102
ask "switch on" 201#0700 181#3302
ask "enable" 201#0F00 181#3716
said "track left (node 1): operation enabled"
ask "1000 counts/s: off the mark, moving, target reached" 601#23FF6000E8030000 581#60FF600000000000 181#3712 181#3702 181#3706
ask "quick stop, and without torque at its end" 201#0200 181#1702 181#5002

echo "node 1 fault 0x2310" >&3
expect "a fault: emergency message; without torque there is no reaction to wait for" 081#1023030000000000 181#1802
said "track left (node 1): fault"
ask "fault reset" 201#8000 081#0000000000000000 181#5002
echo "track sideways silent" >&3
said "fault 'track sideways silent': it must begin with node NUMBER"

ip link set vcan0 down
said "went down"
wait "$listener" 2>/dev/null
ip link set vcan0 up
said "the bus is up again"
listen 02
ask "it has lived on" 601#4000100000000000 581#4300100092010200

kill "$server"
wait "$server"; status=$?
[ $status = 0 ] || fail "exit status $status after SIGTERM, not 0"

"$candrives" --interface vcan7 --ideal </dev/null >out 2>errors && fail "an interface that does not exist: exit status 0"
said "no network interface 'vcan7'"

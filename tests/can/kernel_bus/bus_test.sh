#!/usr/bin/env bash
# On the bus: bus_test.sh CAN_PROBE. vcan0 and vcan1 are up; the test may do with them what it likes.
#
# 1. A frame that cansend sends is the one that candump shows, on its own bus alone.
# 2. It is a bus of classic CAN: a CAN FD frame is refused.
# 3. Raw sockets with filters, error frames and BCM sockets work (can_probe).
# 4. An interface that is down takes no frames, and takes them again when it is up again.
set -uo pipefail
probe=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "bus_test: $*" >&2; exit 1; }

# Sent until it was seen: candump does not say when it listens.
candump -n 1 -L vcan0 >"$work/vcan0" & listener=$!
candump -L vcan1 >"$work/vcan1" & other=$!
while kill -0 "$listener" 2>/dev/null; do cansend vcan0 123#DEADBEEF || fail "1: cansend"; sleep 0.05; done
grep -q ' vcan0 123#DEADBEEF$' "$work/vcan0" || fail "1: candump showed '$(cat "$work/vcan0")'"
kill "$other"
[ ! -s "$work/vcan1" ] || fail "1: vcan1 heard '$(cat "$work/vcan1")'"

! cansend vcan0 123##1DEADBEEF >/dev/null 2>&1 || fail "2: a CAN FD frame was taken"

"$probe" vcan0 || fail "3: can_probe"

ip link set vcan0 down
! cansend vcan0 123#00 2>/dev/null || fail "4: a frame was taken while vcan0 was down"
ip link set vcan0 up
cansend vcan0 123#00 || fail "4: no frame was taken after vcan0 was up again"

#!/usr/bin/env bash
# On the bus, with a camera of the kernel's (with-vcan.sh --camera): pictures by hrt.h over libkenaf_real: camera_test.sh BIN_DIR ROBOT
#
# 1. A camera that the robot has not, and one without a device, are refused in words.  2. RGB: vivid's colour bars in their colours.
# 3. JPEG: made of them; numbers grow, the age is that of a picture from a camera of 10 Hz, and robot time agrees.
# 4. Unplugged: named, the robot goes on; plugged in again, it gives pictures again.  5. A resolution that the device has
# not: refused, with those it has.
set -uo pipefail
. "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/waiting.sh"
bin=$(realpath "$1") robot=$(realpath "$2")
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { cat out ./*.log; echo "camera_test: $*" >&2; exit 1; }
said() { grep -qE -- "$2" out || fail "$1: it does not say '$2'"; }

device=$(grep -ls '^vivid' /sys/class/video4linux/*/name | head -n 1)
device=/dev/$(basename "$(dirname "$device")")
[ -c "$device" ] || fail "there is no camera of vivid: with-vcan.sh --camera makes one"

# The robot's first camera is the device; vivid's webcam has 320 x 180 and 10 pictures a second.
describe() { awk -v device="$device" -v height="$1" '
  /^\[\[camera\]\]/ { n++ }
  n == 1 && /^width/ { print "device = \"" device "\""; print "width = 320"; next }
  n == 1 && /^height/ { print "height = " height; next }
  n == 1 && /^rate_hz/ { print "rate_hz = 10.0"; next }
  { print }' "$robot"; }
describe 180 >robot.toml
describe 200 >other.toml

"$bin/set_control" "$device" "OSD Text Mode" 2 || fail "the camera writes over its picture"  # 2: no text

export KENAF_CAN_INTERFACE=vcan0 KENAF_CAN_TIMEOUT_S=30 KENAF_CONFIG=''
"$bin/kenaf-candrives" --interface vcan0 --ideal --robot "$PWD/robot.toml" >drives.log 2>&1 & drives=$!
wait_until 30 holds drives.log 'nodes on vcan0'

mkfifo input
KENAF_ROBOT=$PWD/robot.toml timeout 200 "$bin/camera_reader" Camera <input >out 2>&1 & reader=$!
exec 3>input
told_to_unplug_or_gone() { holds out 'unplug it' || ! kill -0 "$reader" 2>/dev/null; }
wait_until 60 told_to_unplug_or_gone
said 1 "^Rear: HRT_E_DEVICE: robot '.*' has no camera 'Rear'; it has: Camera, BirdsEye"
said 1 "^BirdsEye: HRT_E_DEVICE: camera 'BirdsEye' of robot '.*' has no device: add device"
said 2 '^rgb 320 x 180, 172800 bytes'
# Eight bars, of which each colour is on in four, at 75 % of 255: 96 on average.
awk '/^mean/ { n++; if ($3 < 92 || $3 > 99 || $5 < 92 || $5 > 99 || $7 < 92 || $7 > 99) exit 1 } END { exit n != 1 }' out ||
  fail "2: $(grep '^mean' out)"
[ "$(grep -cE '^jpeg 320 x 180 of Camera: ffd8 \.\.\. ffd9, number higher, age' out)" = 3 ] || fail "3: not three JPEG files"
# Taken within the last 0.1 s and handed on at once; a time stamp at the picture's end adds 0.1 s; a second for a busy machine.
# Robot time is that of the cycle before: within two cycles.
awk '/^jpeg/ { age = $13; by_robot = $18; if (age < 0 || age > 1200 || age - by_robot > 30 || by_robot - age > 30) exit 1 }' out ||
  fail "3: ages: $(grep '^jpeg' out)"

"$bin/set_control" "$device" Disconnect 1 || fail "4: the camera cannot be unplugged"
echo >&3
exec 3>&-
wait "$reader" || fail "4: the program ended with status $?"
said 4 "^unplugged: HRT_E_DEVICE: camera 'Camera': $device is gone"
said 4 '^the robot: HRT_OK'
said 4 '^plugged in: HRT_OK'
grep -E '^(mean|jpeg|unplugged)' out

KENAF_ROBOT=$PWD/other.toml timeout 200 "$bin/camera_reader" Camera </dev/null >out 2>&1 && fail "5: exit status 0"
said 5 "has no pictures of 320 x 200; it has: YUYV 320 x 180, 640 x 360"
kill "$drives"; wait "$drives"

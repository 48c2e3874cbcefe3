#!/usr/bin/env bash
# On the bus: how long the robot's tracks still run after each way of losing control, what the program says, and whether it
# comes back: stop_times_test.sh BIN_DIR
#
# kenaf-candrives writes the true position of the robot each 10 ms, and the time at which it received a fault, both by its own clock.
# In the moment before the event it receives a harmless line, so that its clock says when the event was. The drives run on
# from one event to the next: each time another program takes them over.
#
# Each event: the tracks stand within 0.2 s; then, by name: 1. the program is killed; 2. stopped (SIGSTOP); 3. its own thread hangs;
# 4. the interface goes down and up; 5. the bus is off; 6. a drive falls silent; 7. a drive is in fault; 8. a drive restarts.
# 9. The inclinometer falls silent: the robot drives on, and the program is notified. (3 is counted from up to 0.06 s after the last call.)
# 10. Drives that have node guarding alone, neither heartbeat nor event timer: the program's requests end with it.
set -uo pipefail
. "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/waiting.sh"
bin=$1 robot=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../../../share/robots/kenaf.toml
work=$(mktemp -d)
trap 'kill -9 $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "stop_times_test: $*" >&2; cat drives.log program.log >&2; exit 1; }
export KENAF_CAN_INTERFACE=vcan0 KENAF_CAN_TIMEOUT_S=10

# said FILE WORDS: waits for them.
said() { wait_until 10 holds "$1" "$2" || fail "$claim: $1 does not say '$2'"; }
tell() { echo "$*" >&3; }

begin() {  # CLAIM [ARGUMENT...]: the program is started, and the robot in motion
  claim=$1; shift
  : >program.log  # what the one before said
  "$bin/keep_driving" "$@" >program.log 2>&1 & program=$!
  said program.log driving
}
end() { kill -9 "$program" 2>/dev/null; wait "$program" 2>/dev/null; }
# The time between the line of drives.log that holds WORDS and the last row in which a track still moved (more than 0.1 mm in 10 ms).
stop_time() {
  pause 1.1  # the path is written out once a second
  local from
  from=$(grep -F -- "$1" drives.log | tail -n 1 | sed 's/^kenaf-candrives: \([0-9.]*\) s:.*/\1/')
  awk -F, -v from="$from" '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { left = $column["track_left_m"]; right = $column["track_right_m"]
      if (NR > 2 && (left - l > 1e-4 || right - r > 1e-4)) last = $column["t_s"]
      if (last == $column["t_s"] && last <= from) before = last
      l = left; r = right }
    END { if (before == "") exit 1; printf "%.3f", (last > from ? last - from : 0) }' path.csv || fail "$claim: the robot did not move before the event at $from s"
}
# stands CLAIM_WORDS SINCE_WORDS
stands() {
  local time_s
  time_s=$(stop_time "$2") || exit 1
  printf '%-46s tracks at rest after %s s\n' "$1" "$time_s"
  awk -v t="$time_s" 'BEGIN { exit !(t <= 0.2) }' || fail "$claim: $time_s s are more than 0.2 s"
}
mark='received: all healed'

claim="the drives start"
mkfifo input; touch drives.log program.log
"$bin/kenaf-candrives" --interface vcan0 --time-step 0.004 --log path.csv <input >drives.log 2>&1 & drives=$!
exec 3>input
said drives.log 'nodes on vcan0'

begin 1; tell all healed; kill -9 "$program"; stands "program killed" "$mark"; end 2>/dev/null
begin 2; tell all healed; kill -STOP "$program"; stands "program stopped (SIGSTOP)" "$mark"
# It goes on, with beats of the bus in its socket: nothing that it says may enable a drive (bits 0 to 3 of the controlword).
candump -L vcan0 >resumed & watching=$!
pause 0.5; kill -CONT "$program"; said program.log "lost: this program was held up for"
pause 0.5; kill "$watching"; wait "$watching" 2>/dev/null
grep -E ' 20[1-6]#[0-9A-F]F' resumed && fail "2: it has enabled drives that had stopped by themselves"
grep -qE ' 20[1-6]#0200' resumed || fail "2: it has not commanded the drives to stop"
end 2>/dev/null
begin 3 120; said program.log hanging; tell all healed; stands "program's own thread hangs" "$mark"; end 2>/dev/null

begin 4; tell all healed; ip link set vcan0 down; stands "interface down" "$mark"
said program.log "lost: CAN interface 'vcan0' went down"; ip link set vcan0 up; said program.log recovered; end

# An error frame as a driver gives it: CAN_ERR_FLAG with CAN_ERR_BUSOFF (<linux/can/error.h>).
begin 5; tell all healed; printf '(0.000000) vcan0 20000040#0000000000000000\n' | canplayer; stands "bus off" "$mark"
said program.log "bus off"; said program.log recovered; end

drive_fault() {  # CLAIM WORDS FAULT PROGRAM_WORDS
  begin "$1"; tell "$3"; said program.log "$4"; stands "$2" "received: $3"
  tell all healed; said program.log recovered; end
}
drive_fault 6 "track right silent" "node 2 silent" "lost: track right (node 2) has been silent"
drive_fault 7 "flipper rear left in fault" "node 5 fault 0x2310" "0x2310"
drive_fault 8 "track left restarts" "node 1 power loss" "lost: track left (node 1)"

begin 9; tell inclinometer silent; said program.log "degraded: inclinometer (node 7) is silent"
pause 0.5; kill -0 "$program" || fail "9: the program ended"
echo "inclinometer silent                            the robot drives on, degraded"
end 2>/dev/null; tell inclinometer healed

sed 's/^\[can\]$/&\nevent_timer = false/; s/^\[can\.\(track\|flipper\)\]$/&\ndevice = "node-guarding"/' "$robot" >guarding.toml
[ "$(grep -c -e '^event_timer' -e '^device = "node-guarding"' guarding.toml)" = 3 ] || fail "10: no robot with node guarding"
for node in 1 2 3 4 5 6; do tell "node $node node guarding only"; done
said drives.log 'received: node 6 node guarding only'
export KENAF_ROBOT=$PWD/guarding.toml
begin 10; tell gyro healed; kill -9 "$program"; stands "program killed, drives with node guarding alone" 'received: gyro healed'
end 2>/dev/null

exec 3>&-
kill "$drives"; wait "$drives" || fail "kenaf-candrives ended with status $?"

#!/usr/bin/env bash
# Throws malformed, truncated, oversized and hostile input at a running world server and relay.
#
#   scripts/throw-garbage.sh WORLD_PORT RELAY_PORT [ROUNDS]
#
# Loopback only. Ends with 0 when all of it was thrown; that both programs still serve is for the caller to check.
# A connection that the server closes on us is an allowed answer.
set -uo pipefail
world_port=${1:?usage: throw-garbage.sh WORLD_PORT RELAY_PORT [ROUNDS]}
relay_port=${2:?usage: throw-garbage.sh WORLD_PORT RELAY_PORT [ROUNDS]}
rounds=${3:-20}
host=127.0.0.1

to_world() { { cat >"/dev/tcp/$host/$world_port"; } 2>/dev/null || true; }
to_relay() { { cat >"/dev/udp/$host/$relay_port"; } 2>/dev/null || true; }
noise() { head -c "$1" /dev/urandom; }
repeat() { head -c "$2" < <(yes "$1"); }

# Text that is almost a message.
almost=(
  '{' '}' '{}' 'INIT' 'INIT {' 'INIT {ClassName' 'INIT {ClassName}' 'INIT {ClassName USARBot.None}'
  'INIT {ClassName ../../../../etc/passwd}' 'INIT {ClassName USARBot.Kenaf} {Location nan,inf,-inf}'
  'INIT {ClassName USARBot.Kenaf} {Location 1e308,1e308,1e308}' 'INIT {ClassName USARBot.Kenaf} {Location 1}'
  'DRIVE {Left nan} {Right inf}' 'DRIVE {Left 1e999} {Right -1e999}' 'DRIVE {Left 0x10} {Right %s%n}'
  'DRIVE {Frame -1}' 'DRIVE {Left 1} {Right 1} {Frame 99999999999999999999}' 'MULTIDRIVE {FRFlipper 1e300}'
  'SET {Type Joint} {Name FRFlipper} {Opcode 99} {Params x}' 'MISPKG {Name CameraPanTilt} {Link 4294967297} {Value 1}'
  'CONTROL {Type Step} {Steps 18446744073709551615}' 'CONTROL {Type Speed} {Value -1}' 'CONTROL {Type Session} {Period 0}'
  'CONTROL {Type Session} {Period 1e-300} {Precision 4000}' 'GETGEO {Type}' 'GETCONF' 'PING' 'PING {Id}'
  $'DRIVE\0{Left 1}' 'DRIVE {{{{Left 1}}}}' 'drive{left 1}{right' "$(printf 'DRIVE %0.s{A b}' {1..500})"
)

for ((round = 0; round < rounds; ++round)); do
  printf '%s\r\n' "${almost[@]}" | to_world
  printf 'INIT {ClassName USARBot.Kenaf} {Name G%d}\r\nDRIVE {Left' "$round" | to_world    # truncated, then closed
  { printf 'INIT {ClassName USARBot.Kenaf} {Name H%d}\r\n' "$round"; printf '%s\r\n' "${almost[@]}"; } | to_world
  noise 20000 | to_world
  repeat 'A' 300000 | tr -d '\n' | to_world                                                # a line without an end
  repeat 'DRIVE {Left 1} {Right 1}' 100000 | to_world                                      # a flood without INIT

  : | to_relay
  for size in 1 7 8 23 24 64 200 511 512 513 9000; do noise "$size" | to_relay; done
  for kind in 0 1 2 3 4 5 6 7 8 9 128 129 130 255; do                                      # right magic, wrong rest
    { printf 'KNAF\1'; printf "\\x$(printf %02x "$kind")"; noise 90; } | to_relay
    { printf 'KNAF\1'; printf "\\x$(printf %02x "$kind")"; printf '\x10\0'; noise 8; } | to_relay
  done
  printf '%s\r\n' "${almost[@]}" | to_relay                                                # the wrong protocol
done
echo "throw-garbage: $rounds rounds thrown at world server port $world_port and relay port $relay_port"

#!/usr/bin/env bash
# Drives the square example on the simulated robot and draws the path it drove.
#
#   scripts/demo.sh [OUT_DIR]      default: demo-out
#
# Installs what is missing, builds, starts the world server and the relay on free loopback ports, runs the example
# against libkenaf_sim, draws OUT_DIR/square.png, stops everything. Exit status 0: the square closed within 10 mm and
# 2 degrees.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=$(mkdir -p "${1:-demo-out}" && cd "${1:-demo-out}" && pwd)
cd "$root"

say() { printf 'demo: %s\n' "$*"; }
fail() { printf 'demo: %s\n' "$*" >&2; exit 1; }

scripts/install-dependencies.sh build
say "building (the first time takes a few minutes)"
{ cmake --preset install && cmake --build --preset install --target kenaf-world kenaf-relayd kenaf-draw square_sim; } \
  >"$out/build.log" 2>&1 || { tail -n 40 "$out/build.log" >&2; fail "the build failed, all of it is in $out/build.log"; }
bin=build/install/bin

pids=()
stop_all() {
  local status=$? pid
  for pid in "${pids[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || { say "process $pid did not end cleanly"; status=1; }; done
  exit "$status"
}
trap stop_all EXIT

# Starts a server in the background and waits until it has written the port it listens on.
port_of() {
  local file=$1 pid=$2 log=$3
  for _ in $(seq 100); do
    [ -s "$file" ] && { cat "$file"; return; }
    kill -0 "$pid" 2>/dev/null || break
    sleep 0.1
  done
  cat "$log" >&2
  return 1
}

rm -f "$out"/{world,relay}.port "$out"/square.csv "$out"/square.png
"$bin/kenaf-world" --world flat --port 0 --port-file "$out/world.port" --view off --cameras off \
  >"$out/world.log" 2>&1 & pids+=($!)
world_port=$(port_of "$out/world.port" "${pids[0]}" "$out/world.log") || fail "the world server did not start"
say "world server on port $world_port"

"$bin/kenaf-relayd" --world-server "127.0.0.1:$world_port" --listen 127.0.0.1:0 --port-file "$out/relay.port" \
  >"$out/relay.log" 2>&1 & pids+=($!)
relay_port=$(port_of "$out/relay.port" "${pids[1]}" "$out/relay.log") || fail "the relay did not start"
say "relay on port $relay_port"

say "driving the square"
KENAF_RELAY="127.0.0.1:$relay_port" KENAF_RECORD="$out/square.csv" "$bin/square_sim" ||
  fail "the square example failed; logs are in $out"

"$bin/kenaf-draw" "$out/square.csv" --world flat --out "$out/square.png"

closes=yes
said=$(scripts/closing-error.sh "$out/square.csv") || closes=no
say "$said"
[ "$closes" = yes ] || fail "the square did not close within 10 mm and 2 degrees"
say "picture: $out/square.png, record: $out/square.csv"

#!/usr/bin/env bash
# Writes what a build makes of the same inputs into a folder: paths, reports, pictures, transcripts. Of two builds that
# behave the same, bit for bit, the folders are equal:
#
#   scripts/golden.sh OUT [BUILD]         BUILD: default build/release
#   diff -r OUT_BEFORE OUT_AFTER
#
# Nothing in it depends on time, place or the number of cores. Takes about ten minutes on two cores.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
[ $# -ge 1 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
build=$(cd "${2:-$root/build/release}" && pwd)
[ -z "$(ls -A "$out")" ] || { echo "golden: $out holds something; give an empty folder" >&2; exit 2; }
export KENAF_DATA_DIR=$root/share PATH="$build/bin:$PATH" LD_LIBRARY_PATH="$build/lib"
scratch=$(mktemp -d)
pids=()
stop() { for pid in "${pids[@]}"; do kill -TERM "$pid" 2>/dev/null && wait "$pid" || true; done; pids=(); }
trap 'stop; rm -rf "$scratch"' EXIT
say() { printf 'golden: %s (%d s)\n' "$1" "$SECONDS"; }

say "paths of all manoeuvres"
mapfile -t manoeuvres < <(kenaf-gap manoeuvres | awk 'NR > 1 { print $1 }')
kenaf-gap manoeuvres >"$out/manoeuvres.txt"
for manoeuvre in "${manoeuvres[@]}"; do
  kenaf-gap simulate --manoeuvre "$manoeuvre" --out "$out/paths/$manoeuvre" >"$scratch/log" 2>&1 ||
    mv "$scratch/log" "$out/paths-$manoeuvre.txt"
done
for robot in marmotte p2at p2dx; do
  kenaf-gap simulate --robot "$robot" --manoeuvre straight --manoeuvre random-speeds --manoeuvre ramp \
    --out "$out/robots/$robot" >"$out/robots-$robot.txt" 2>&1 || true
done
kenaf-gap simulate --manoeuvre random-speeds --manoeuvre step-100 --physics time_step_s=0.0005 \
  --physics solver_iterations=20 --out "$out/finer" >/dev/null

say "every effect"
kenaf-gap effects >"$out/effects.txt"
kenaf-gap effects --robot kenaf >"$out/candidates.txt"
awk '/^  [a-z_]+ / { name = $1 } /^ +[a-z_0-9]+ from / { sub(";", "", $5); print name ":" $1, $3, $5 }' "$out/effects.txt" |
  while read -r parameter from to; do
    value=$(awk "BEGIN { print $from + 0.6 * ($to - $from) }")
    kenaf-gap simulate --manoeuvre speed-steps --manoeuvre step-100 --effect "$parameter=$value" \
      --out "$out/effects/${parameter/:/-}" >"$scratch/log" 2>&1 || mv "$scratch/log" "$out/effects-${parameter/:/-}.txt"
  done

say "datasets and comparisons"
cd "$scratch"
kenaf-gap simulate --manoeuvre straight --manoeuvre turn-in-place --repeats 2 --effect drive_lag:lag_s=0.1 \
  --physics time_step_s=0.0005 --out real >/dev/null
kenaf-gap simulate --manoeuvre straight --manoeuvre turn-in-place --repeats 2 --out sim >/dev/null
kenaf-gap check real >"$out/check.txt" || true
kenaf-gap compare real sim --out "$out/compare" | grep -v has.the.figures >"$out/compare.txt"
kenaf-gap dataset straight=real/run-000.csv turn-in-place=real/run-002.csv turn-in-place=real/run-003.csv \
  --out "$out/dataset" 2>&1 | grep -v 'in a new dataset' >"$out/dataset.txt"
kenaf-gap merge real/run-000.csv real/run-001.csv --out "$out/merged.csv" >"$out/merge.txt" 2>&1 || true
kenaf-draw real/run-002.csv --world flat --out "$out/drawn.png"

say "diagnoses"
kenaf-gap diagnose real --out "$out/diagnosis" >"$scratch/log" 2>&1
grep -v '/report.html' "$scratch/log" >"$out/diagnosis.txt"
kenaf-gap diagnose real --against sim --no-next --out "$out/change" >"$scratch/log" 2>&1
grep -v '/report.html' "$scratch/log" >"$out/change.txt"

say "pictures"
for camera in Camera; do
  for world in flat hills rubble-mesh stairs; do
    camera_picture --world "$world" --camera "$camera" --out "$out/picture-$camera-$world.png" >/dev/null
  done
done

# Starts a program that writes its port into a file, and waits for the port.
port=
start() {
  rm -f port
  "$@" --port-file "$scratch/port" >"$scratch/server.log" 2>&1 &
  pids+=($!)
  until [ -s port ]; do
    kill -0 "${pids[-1]}" 2>/dev/null || { cat server.log >&2; exit 1; }
    sleep 0.05
  done
  port=$(cat port)
}

# A client of the text protocol that asks for each piece of robot time, so that the answers do not depend on the clock.
talk() {  # LINE...
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  local line answer
  for line in "$@"; do
    printf '%s\r\n' "$line" >&3
    [[ $line != *Type\ Step* ]] || while read -r answer <&3; do
      printf '%s\n' "$answer"
      [[ $answer != RES*Name\ Step* ]] || break
    done
  done
  exec 3<&- 3>&-
}

say "transcripts"
for dialect in ut2004 udk; do
  start kenaf-world --world step-150 --port 0 --view off --cameras off --dialect "$dialect"
  talk 'CONTROL {Type Pause}' 'CONTROL {Type Session} {Period 0.05} {Precision 12}' \
    'INIT {ClassName USARBot.Kenaf} {Name Robot} {Location 0,0,0} {Rotation 0,0,0}' \
    'CONTROL {Type Step} {Time 0.5}' 'GETCONF {Type Robot}' 'GETGEO {Type Sensor} {Name Scanner1}' \
    'DRIVE {Left 3} {Right 4}' 'CONTROL {Type Step} {Time 1}' \
    'MULTIDRIVE {FRFlipper 0.5} {FLFlipper 0.5}' 'DRIVE {Name FRFlipper} {Steering 0} {Order 1} {Value 0.5}' \
    'CONTROL {Type Step} {Time 2}' 'SET {Type Camera} {Client 127.0.0.1}' 'DRIVE {Left 5} {Right 5}' \
    'CONTROL {Type Step} {Time 5}' 'rubbish' 'DRIVE {Left nan}' 'CONTROL {Type Reset}' 'CONTROL {Type Step} {Time 0.2}' \
    >"$out/transcript-$dialect.txt"
  stop
done

say "done"

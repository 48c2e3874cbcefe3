#!/usr/bin/env bash
# Makes the pages' pictures and printed figures again, from the commands that the pages give:
#
#   scripts/refresh-figures.sh [NAME...]      NAME: default all but marmotte-report
#
#     birds-eye        a picture of the robot's camera              docs/cameras.md
#     obstacle-drive   a drive over a step, drawn                   README.md
#     compare          the comparison: its table and its page       docs/compare.md
#     gap-report       the tutorial's diagnosis, its first screen   docs/gap-report.md
#     live-view        a robot that is driven by hand               docs/live-view.md
#     playback         a climb beside its simulations               docs/compare.md
#     operator-console the operator's screen on a step              docs/operator.md
#     marmotte-report  a real robot's; needs LOGS, its folder of    docs/gap-marmotte.md
#                      runs (docs/gap-marmotte.md), and ten minutes
#
# Needs a build in build/release (or BUILD) and chromium-headless-shell. `git diff` then shows what was stale.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${BUILD:-$root/build/release}" && pwd)
pictures=$root/docs/pictures
export KENAF_DATA_DIR=$root/share PATH="$build/bin:$PATH" LD_LIBRARY_PATH="$build/lib"
scratch=$(mktemp -d)
servers=()
trap 'stop; rm -rf "$scratch"' EXIT
cd "$scratch"

usage() { sed -n '2,16s/^# \{0,1\}//p' "$root/scripts/refresh-figures.sh"; }
fail() { printf 'refresh-figures: %s\n' "$1" >&2; exit 1; }

# The commands of the first fenced block of PAGE that contains WORDS, run here.
run_block() {  # PAGE WORDS
  python3 - "$root/$1" "$2" >block.sh <<'PYTHON'
import re, sys
page, words = sys.argv[1:]
blocks = [b for b in re.findall(r"```sh\n(.*?)```", open(page).read(), re.S) if words in b]
if not blocks: sys.exit(f"refresh-figures: {page} has no block of commands with '{words}'")
print(blocks[0])
PYTHON
  bash -euo pipefail block.sh
}

# Replaces the first fenced block without a language after the one with WORDS by FILE.
replace_output() {  # PAGE WORDS FILE
  python3 - "$root/$1" "$2" "$3" <<'PYTHON'
import re, sys
page, words, file = sys.argv[1:]
text, output = open(page).read(), open(file).read().rstrip("\n")
commands = re.search(r"```sh\n(?:(?!```).)*?" + re.escape(words) + r".*?```\n", text, re.S)
fence = re.compile(r"^```\n(.*?)^```$", re.S | re.M).search(text, commands.end())
open(page, "w").write(text[: fence.start()] + f"```\n{output}\n```" + text[fence.end() :])
PYTHON
}

# The upper WIDTH x HEIGHT of an HTML file.
screenshot() {  # HTML PNG WIDTH HEIGHT
  chromium-headless-shell --no-sandbox --hide-scrollbars --screenshot="$2" --window-size="$3,$4" "file://$1" \
      >chromium.log 2>&1 && [ -s "$2" ] || fail "no screenshot of $1: $(tail -n 3 chromium.log)"
}

refresh_birds_eye() {
  camera_picture --world step-field --camera BirdsEye --flippers 0.5 --out "$pictures/birds-eye.png"
}

# Starts a program that writes its port into NAME.port; it ends with this script.
start() {  # NAME COMMAND...
  local name=$1; shift
  "$@" --listen 127.0.0.1:0 --port-file "$name.port" >"$name.log" 2>&1 & servers+=($!)
  for _ in $(seq 600); do [ ! -s "$name.port" ] || return 0; sleep 0.1; done
  fail "$1 did not start: $(tail -n 3 "$name.log")"
}
stop() {
  [ ${#servers[@]} -eq 0 ] || kill "${servers[@]}" 2>/dev/null || true
  [ ${#servers[@]} -eq 0 ] || wait "${servers[@]}" || true
  servers=()
}

refresh_obstacle_drive() {
  start relay kenaf-relayd --embedded --world step-150 --view off --cameras off
  KENAF_RELAY=127.0.0.1:$(cat relay.port) KENAF_RECORD=climb.csv obstacle_drive_sim
  stop
  kenaf-draw climb.csv --world step-150 --view side --title "Onto a step of 150 mm" --size 1500x640 \
      --out "$pictures/obstacle-drive.png"
}

refresh_compare() {
  run_block docs/compare.md "compare real sim" | grep -A100 "matched frames" | sed '/has the figures/d' >table.txt
  replace_output docs/compare.md "compare real sim" table.txt
  screenshot "$PWD/compared/compare.html" "$pictures/compare.png" 1100 910
}

refresh_gap_report() {
  run_block docs/gap-tutorial.md "diagnose real --out diagnosis"
  screenshot "$PWD/diagnosis/report.html" "$pictures/gap-report.png" 1100 1330
}

refresh_live_view() { "$root/scripts/pages/picture.py" live-view "$build" "$pictures/live-view.png"; }

refresh_playback() {
  run_block docs/gap-tutorial.md "diagnose real --out diagnosis"
  "$root/scripts/pages/picture.py" playback "$build" "$pictures/playback.png" real diagnosis
}

refresh_operator_console() {
  start relay kenaf-relayd --embedded --world step-200 --view off
  KENAF_RELAY=127.0.0.1:$(cat relay.port) start control operator_control_sim
  "$root/scripts/pages/picture.py" console "$build" "$pictures/operator-console.png" "$(cat control.port)"
  stop
}

refresh_marmotte_report() {
  [ -n "${LOGS:-}" ] || fail "marmotte-report needs LOGS=FOLDER, the runs of docs/gap-marmotte.md"
  kenaf-gap diagnose "$LOGS" --out marmotte
  screenshot "$PWD/marmotte/report.html" "$pictures/marmotte-report.png" 1200 1330
}

[ "${1:-}" != --help ] || { usage; exit 0; }
names=("$@")
[ ${#names[@]} -gt 0 ] || names=(birds-eye obstacle-drive compare gap-report live-view playback operator-console)
for name in "${names[@]}"; do
  declare -F "refresh_${name//-/_}" >/dev/null || { usage >&2; printf "refresh-figures: no figure '%s'\n" "$name" >&2; exit 2; }
done
for name in "${names[@]}"; do
  printf 'refresh-figures: %s\n' "$name"
  rm -rf "${scratch:?}"/*
  "refresh_${name//-/_}"
done

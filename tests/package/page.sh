#!/usr/bin/env bash
# The installed pages work: every file that the live view and the playback name is served. What an option asked for and
# cannot be served ends the program.
#
#   page.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
cp -a "$installed" "$work/prefix"
prefix=$work/prefix
cd "$work"
url_of() { grep -oE 'http://127\.0\.0\.1:[0-9]+/' "$1"; }
world=("$prefix/bin/kenaf-world" --port 0 --cameras off)

start world.log 'live view: http' "${world[@]}" --view 127.0.0.1:0
"$source/tests/package/fetch_page.py" "$(url_of world.log)" main.js three.module.js OrbitControls.js
stop

if [ -x "$prefix/bin/kenaf-gap" ]; then
  "$prefix/bin/kenaf-gap" simulate --manoeuvre straight --out runs
  start play.log 'http://127' "$prefix/bin/kenaf-gap" play runs --view 127.0.0.1:0
  "$source/tests/package/fetch_page.py" "$(url_of play.log)" playback.js three.module.js OrbitControls.js
  stop
fi

# refuses WORDS COMMAND...
refuses() {
  local words=$1 said status=0; shift
  said=$("$@" 2>&1) || status=$?
  [ "$status" = 1 ] || fail "$* ended with status $status: $said"
  grep -qF "$words" <<<"$said" || fail "$* did not say '$words': $said"
}
for lost in three/build/three.module.js page/index.html; do
  rm "$prefix/share/kenaf/$lost"
  refuses "$lost" "${world[@]}" --view 127.0.0.1:0
  refuses "$lost" "$prefix/bin/kenaf-relayd" --embedded --cameras off --listen 127.0.0.1:0 --view-token chosen
  # nobody asked: a warning
  start world.log 'world .* on ' "${world[@]}"
  grep -q 'no live view' world.log || { cat world.log; fail "the missing $lost is not named"; }
  stop
done
start first.log 'camera pictures on' "$prefix/bin/kenaf-world" --port 0 --view off --camera-port 0
refuses 'no image server' "$prefix/bin/kenaf-world" --port 0 --view off \
  --camera-port "$(grep -oE 'camera pictures on .*' first.log | grep -oE '[0-9]+$')"
stop

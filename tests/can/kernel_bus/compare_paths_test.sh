#!/usr/bin/env bash
# Two runs of one path agree within any limit above 0; anything else for a limit is refused: compare_paths_test.sh BIN_DIR
set -uo pipefail
bin=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "compare_paths_test: $*" >&2; exit 1; }

cat >"$work/run.csv" <<'END'
t_s,x_m,y_m,yaw_rad
0,0,0,0
0.01,0.001,0,0
0.02,0.002,0,0
END
compare() { "$bin/compare_paths" "$work/run.csv" "$work/run.csv" "$@" >"$work/out" 2>"$work/error"; }

compare 5 1 || fail "a path differs from itself: $(cat "$work/out" "$work/error")"
for limit in "" 0 -1 5mm nan inf 0x5; do
  for limits in "$limit,1" "5,$limit"; do
    compare "${limits%,*}" "${limits#*,}"
    [ $? = 2 ] && grep -q "compare_paths: LIMIT_.* '$limit': must be a number above 0" "$work/error" ||
      fail "limits $limits: $(cat "$work/out" "$work/error")"
  done
done
compare 5
[ $? = 2 ] && grep -q usage "$work/error" || fail "one limit alone: $(cat "$work/error")"
compare 5 1 more
[ $? = 2 ] && grep -q usage "$work/error" || fail "an argument too many: $(cat "$work/error")"

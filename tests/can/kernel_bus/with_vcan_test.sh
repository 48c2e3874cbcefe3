#!/usr/bin/env bash
# What scripts/with-vcan.sh promises of any command: with_vcan_test.sh WITH_VCAN
#
# 1. --check names a way.                                  5. Its standard input is empty.
# 2. The command's exit status is passed on.               6. It may write below --writable, and not beside it.
# 3. Standard output and error are, each on its own.       7. What it leaves running does not keep it from ending.
# 4. Arguments, environment and working directory are.     8. --timeout stops it: status 124 and words.
#                                                          9. Where the kernel has a bus, the way is direct.
set -uo pipefail
with_vcan=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "with_vcan_test: $*" >&2; exit 1; }

way=$("$with_vcan" --check) || fail "1: --check failed"
[[ $way =~ ^(direct|kvm|tcg): ]] || fail "1: --check said '$way'"
echo "way: $way"

mkdir "$work/writable, indeed"
cd "$work/writable, indeed" || exit 1
status=0
KENAF_VCAN_TEST=$'two\nlines' "$with_vcan" --timeout 800 --writable . bash -c '
  printf "<%s>" "$@" "$KENAF_VCAN_TEST" "$PWD"
  echo "to standard error" >&2
  read -r line && echo "there is input: $line"
  echo written >file
  # Nothing beside it: where the machine shows a copy of /tmp, it is dropped; direct, it is the caller that is trusted.
  case $0 in *"kvm:"*|*"tcg:"*) echo lost >../beside; touch /usr/beside 2>/dev/null && echo "/usr is writable" ;; esac
  '"$with_vcan"' --check | grep -q "^direct: " || echo "not direct where there is a bus"
  [ "'"${way%%:*}"'" = direct ] || sleep 1000 &
  exit 7' "$way" 'a b' '' '$HOME *' $'c\nd' <<<'input' >"$work/out" 2>"$work/err" || status=$?
[ "$status" = 7 ] || { cat "$work/out" "$work/err"; fail "2: exit status $status, not 7"; }
printf '<%s>' 'a b' '' '$HOME *' $'c\nd' $'two\nlines' "$PWD" >"$work/expected"
cmp "$work/out" "$work/expected" || { cat "$work/out"; fail "3, 4, 5, 6, 9: the output above is not $(cat "$work/expected")"; }
[ "$(cat "$work/err")" = 'to standard error' ] || { cat "$work/err"; fail "3: that was on standard error"; }
[ "$(cat file)" = written ] || fail "6: the file below --writable is not there"
[ ! -e "$work/beside" ] || fail "6: a file beside --writable is there"

status=0
"$with_vcan" --timeout 5 sleep 1000 2>"$work/err" || status=$?
[ "$status" = 124 ] || fail "8: exit status $status, not 124"
grep -q 'did not end within 5 s' "$work/err" || { cat "$work/err"; fail "8: no word of the time-out"; }

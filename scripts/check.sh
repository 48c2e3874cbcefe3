#!/usr/bin/env bash
# Checks what no build checks: that all sources are formatted, that each file compiles alone, and that clang-tidy finds
# nothing in those that a change touches.
#
#   scripts/check.sh           the change: what differs from the commit before, or from $BASE
#   scripts/check.sh --all     the change: everything; takes an hour
#
# Neither of the last two starts a further file after $CHECK_SECONDS (default: no limit); files that the change affects
# come first. Says how many it checked. Exit status 0: nothing found.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  --all) since=$(git hash-object -t tree /dev/null) ;;
  "") since=${BASE:-HEAD~1} ;;
  *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
scripts/install-dependencies.sh

# a source package has no history: then all that is there is looked at
all_sources() { find . -path ./build -prune -o \( -name '*.cpp' -o -name '*.hpp' -o -name '*.c' -o -name '*.h' \) -print; }
if ! all_sources | xargs clang-format --dry-run --Werror; then
  echo "check: these files are not formatted; clang-format -i FILE does it" >&2
  exit 1
fi

if ! git rev-parse --quiet --verify "$since^{tree}" >/dev/null 2>&1; then
  echo "check: there is no $since to compare with; formatting alone was checked"
  exit 0
fi
mkdir -p build
cmake --preset debug -B build/check -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >build/check.log 2>&1 || { cat build/check.log >&2; exit 1; }
mapfile -t files < <(git diff --name-only --diff-filter=d "$since" -- '*.cpp' '*.hpp' '*.c' ':!bench/engines' ':!tests/fuzz')

scripts/compile-alone.py build/check --seconds "${CHECK_SECONDS:-inf}" --first "${files[@]}"

CHECK_UNTIL=$(($(date +%s) + ${CHECK_SECONDS:-1000000}))
export CHECK_UNTIL
check_file() {
  if [ "$(date +%s)" -ge "$CHECK_UNTIL" ]; then echo "$1" >>build/check.left; return; fi
  clang-tidy --quiet --warnings-as-errors='*' -p build/check "$1" 2>/dev/null || { echo "check: $1" >&2; return 1; }
}
export -f check_file
: >build/check.left
if [ ${#files[@]} -gt 0 ]; then
  printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -I{} bash -c 'check_file "$1"' check_file {} || exit 1
fi
echo "check: all files are formatted; $((${#files[@]} - $(wc -l <build/check.left))) of ${#files[@]} touched files are without a finding of clang-tidy"

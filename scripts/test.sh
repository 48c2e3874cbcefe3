#!/usr/bin/env bash
# Builds and runs all tests.
#
#   scripts/test.sh                 check, release, asan, fuzz and tsan
#   scripts/test.sh release asan    only the named parts, of:
#       check     scripts/check.sh, its two slow parts for 60 s each
#       release   g++, as installed: all tests but those of `bus`, the package
#       asan      clang, address and undefined behaviour sanitizers: the rooms that take input from others, without what only calculates
#       fuzz      the fuzzers of that build, 1 s each: all but kenaf-gap's
#       tsan      g++, thread sanitizer: the relay and the libraries
#       bus       release, more robots on a CAN bus: minutes each where the bus has to be emulated
#       asan-all  asan with all rooms; then all fuzzers, FUZZ_SECONDS each (default 60). Takes most of an hour.
#
# Installs what is missing. Exit status 0: all tests passed.
set -euo pipefail
cd "$(dirname "$0")/.."

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(check release asan fuzz tsan)
jobs=$(nproc)
tests_at_once=$((jobs + 2))  # some of the longest wait for a clock and need no processor
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache CMAKE_C_COMPILER_LAUNCHER=ccache
export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=halt_on_error=1

step() { printf '\n== %s (%d s so far)\n' "$*" "$SECONDS"; }

# Configures and builds a preset quietly; on failure shows the end of the log.
build() {
  local preset=$1; shift
  mkdir -p build
  step "build $preset"
  if ! { cmake --preset "$preset" && cmake --build --preset "$preset" -j "$jobs" "$@"; } >"build/$preset.log" 2>&1; then
    tail -n 60 "build/$preset.log"
    echo "test: the build of '$preset' failed; its whole log is build/$preset.log" >&2
    exit 1
  fi
}

run_check() {
  step "check"
  CHECK_SECONDS=60 scripts/check.sh
}

run_release() {
  build release
  step "tests, release"
  ctest --preset release -j "$tests_at_once" -LE more-robots
}

run_bus() {
  build release
  step "more robots on a CAN bus, release"
  ctest --preset release -j "$jobs" -L more-robots
}

run_asan() { sanitized_tests asan 'release-only|calculates'; }
sanitized_tests() {  # PRESET LABELS_LEFT_OUT
  build "$1"
  step "tests under address and undefined behaviour sanitizers"
  ctest --preset "$1" -j "$tests_at_once" -LE "$2" -E '^abi:'
}

run_tsan() {
  build tsan --target threaded_tests
  step "tests of relay and libraries under the thread sanitizer"
  ctest --preset tsan -j "$tests_at_once" -L 'relayd|hrt' -E '^abi:'
}

run_fuzz() { fuzz asan 1; }
fuzz() {  # PRESET SECONDS
  build "$1" --target fuzzers
  step "fuzzers, $2 s each"
  export -f run_fuzzer
  grep . "build/$1/fuzzers.txt" | xargs -P "$jobs" -I{} bash -c 'run_fuzzer {} "$@"' run_fuzzer "build/$1" "$2"
}

run_asan-all() {
  sanitized_tests asan-all release-only
  fuzz asan-all "${FUZZ_SECONDS:-60}"
}

# One fuzzer; says one line, or what it found. 255 keeps xargs from starting more.
run_fuzzer() {
  local fuzzer=$1 build=$2 seconds=$3
  local found="$build/found/$fuzzer" log="$build/$fuzzer.log"
  mkdir -p "$found"
  if ! "$build/bin/$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 \
      -artifact_prefix="$found/" "$found" "tests/fuzz/corpus/$fuzzer" >"$log" 2>&1; then
    tail -n 60 "$log"
    echo "test: $fuzzer found an input that fails; it is in $found" >&2
    exit 255
  fi
  printf '%-32s %s\n' "$fuzzer" "$(grep -E '^Done|DONE' "$log" | tail -n 1)"
}

scripts/install-dependencies.sh
for part in "${parts[@]}"; do
  case $part in
    check|release|asan|fuzz|tsan|bus|asan-all) "run_$part" ;;
    *) echo "test: '$part' is not one of check, release, asan, fuzz, tsan, bus, asan-all" >&2; exit 2 ;;
  esac
done
step "all parts passed: ${parts[*]}"

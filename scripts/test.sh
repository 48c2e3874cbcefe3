#!/usr/bin/env bash
# Builds and runs all tests.
#
#   scripts/test.sh                 everything
#   scripts/test.sh release asan    only the named parts, of:
#       release   g++, as installed: all tests, the CAN bus, the package
#       asan      clang, address and undefined behaviour sanitizers: all tests but those, the published table and long runs
#       fuzz      the fuzzers of that build, FUZZ_SECONDS each (default 6)
#       tsan      g++, thread sanitizer: the relay and the libraries
#
# Installs what is missing. Exit status 0: all tests passed.
set -euo pipefail
cd "$(dirname "$0")/.."

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(release asan fuzz tsan)
jobs=$(nproc)
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

run_release() {
  build release
  step "tests, release"
  ctest --preset release -j "$jobs"
}

run_asan() {
  build asan
  step "tests under address and undefined behaviour sanitizers"
  ctest --preset asan -j "$jobs" -LE 'release-only|table1|long' -E '^abi:'
}

run_tsan() {
  build tsan --target threaded_tests
  step "tests of relay and libraries under the thread sanitizer"
  ctest --preset tsan -j "$jobs" -L 'relayd|hrt' -E '^abi:'
}

run_fuzz() {
  build asan --target fuzzers
  step "fuzzers, ${FUZZ_SECONDS:=6} s each"
  local fuzzer
  while read -r fuzzer; do
    [ -n "$fuzzer" ] || continue
    local found="build/asan/found/$fuzzer"
    mkdir -p "$found"
    if ! "build/asan/bin/$fuzzer" -max_total_time="$FUZZ_SECONDS" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 \
        -artifact_prefix="$found/" "$found" "fuzz/corpus/$fuzzer" >"build/asan/$fuzzer.log" 2>&1; then
      tail -n 60 "build/asan/$fuzzer.log"
      echo "test: $fuzzer found an input that fails; it is in $found" >&2
      exit 1
    fi
    printf '%-32s %s\n' "$fuzzer" "$(grep -E '^Done|DONE' "build/asan/$fuzzer.log" | tail -n 1)"
  done <build/asan/fuzzers.txt
}

scripts/install-dependencies.sh
for part in "${parts[@]}"; do
  case $part in
    release|asan|fuzz|tsan) "run_$part" ;;
    *) echo "test: '$part' is not one of release, asan, fuzz, tsan" >&2; exit 2 ;;
  esac
done
step "all parts passed: ${parts[*]}"

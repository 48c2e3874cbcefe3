#!/usr/bin/env bash
# Builds and runs all tests.
#
#   scripts/test.sh                 everything: release, sanitizers, fuzzers, package
#   scripts/test.sh release asan    only the named parts, of: release asan tsan fuzz
#
# Installs what is missing. Exit status 0: all tests passed.
set -euo pipefail
cd "$(dirname "$0")/.."

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(release asan tsan fuzz)
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
  ctest --preset asan -j "$jobs" -LE 'release-only'
}

run_tsan() {
  build tsan --target threaded_tests
  step "tests of everything threaded under the thread sanitizer"
  ctest --preset tsan -j "$jobs" -L threaded -LE 'release-only'
}

run_fuzz() {
  build fuzz --target fuzzers
  step "fuzzers, ${FUZZ_SECONDS:=6} s each"
  local fuzzer
  while read -r fuzzer; do
    [ -n "$fuzzer" ] || continue
    local found="build/fuzz/found/$fuzzer"
    mkdir -p "$found"
    if ! "build/fuzz/bin/$fuzzer" -max_total_time="$FUZZ_SECONDS" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 \
        -artifact_prefix="$found/" "$found" "fuzz/corpus/$fuzzer" >"build/fuzz/$fuzzer.log" 2>&1; then
      tail -n 60 "build/fuzz/$fuzzer.log"
      echo "test: $fuzzer found an input that fails; it is in $found" >&2
      exit 1
    fi
    printf '%-32s %s\n' "$fuzzer" "$(grep -E '^Done|DONE' "build/fuzz/$fuzzer.log" | tail -n 1)"
  done <build/fuzz/fuzzers.txt
}

scripts/install-dependencies.sh
for part in "${parts[@]}"; do
  case $part in
    release|asan|tsan|fuzz) "run_$part" ;;
    *) echo "test: '$part' is not one of release, asan, tsan, fuzz" >&2; exit 2 ;;
  esac
done
step "all parts passed: ${parts[*]}"

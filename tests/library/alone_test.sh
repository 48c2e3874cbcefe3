#!/usr/bin/env bash
# The libraries without the simulator: configured where nothing else is installed, and as a part of another project, which
# builds a program with one of them, and cannot build one with both. scripts/try-debian.sh shows the same on a machine on
# which nothing else is installed.
#
#   alone_test.sh SOURCE_DIR CC CXX
set -euo pipefail
source=$1 cc=$2 cxx=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'alone_test: %s\n' "$*" >&2; exit 1; }

# Whatever CMake could find besides Threads and fmt is hidden from it.
hidden=()
for package in $(grep -rhoE 'find_package\([A-Za-z0-9_]+' "$source" --include=CMakeLists.txt --include='*.cmake' |
                 sed 's/.*(//' | sort -u); do
  case $package in
    Threads | fmt | kenaf) ;;
    *) hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON") ;;
  esac
done
[ ${#hidden[@]} -ge 15 ] || fail "found only ${#hidden[@]} find_package in the project"
hidden+=(-DKENAF_ABIDIFF=OFF -DKENAF_HELP2MAN=OFF)
options=("${hidden[@]}" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release
  -DKENAF_BUILD_SIMULATOR=OFF -DKENAF_COMPILE_TOGETHER=ON)

# By itself, with its tests.
cmake -S "$source" -B "$work/by-itself" "${options[@]}" >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake, by itself"; }
for words in "Catch2 is not installed" "no CLI11" "no abidiff"; do
  grep -qF "$words" "$work/log" || { cat "$work/log"; fail "cmake did not say '$words'"; }
done
tests=$(ctest --test-dir "$work/by-itself" -N)
for name in header: needs: "one library:"; do
  grep -qF "$name" <<<"$tests" || fail "the test '$name' is not in this build: $tests"
done

# As a part of another project, whose own settings stay its own.
mkdir "$work/project"
cp "$source/examples/square.c" "$work/project"
cat >"$work/project/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(stranger C CXX)
add_subdirectory("$source" kenaf)
add_executable(square square.c)
target_link_libraries(square PRIVATE kenaf::sim)
if(BOTH)
  add_executable(both square.c)
  target_link_libraries(both PRIVATE kenaf::sim kenaf::real)
endif()
get_property(targets DIRECTORY "$source" PROPERTY SUBDIRECTORIES)
file(WRITE "\${CMAKE_BINARY_DIR}/folders" "\${targets}\n")
file(WRITE "\${CMAKE_BINARY_DIR}/settings" "\${CMAKE_CXX_STANDARD}\${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\${CMAKE_CXX_VISIBILITY_PRESET}\n")
END
cmake -S "$work/project" -B "$work/build" "${options[@]}" >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake, as a part"; }
! grep -E '/(tests|bench|examples|physics)(;|$)' "$work/build/folders" || fail "the project got Kenaf's tests or benchmarks"
[ -z "$(cat "$work/build/settings")" ] || fail "the project got Kenaf's settings: $(cat "$work/build/settings")"
[ -z "$(find "$work/build" -name "CPackConfig.cmake")" ] || fail "the project got Kenaf's packages"
cmake --build "$work/build" -j 2 >"$work/log" 2>&1 || { tail -n 40 "$work/log"; fail "the other project's build"; }
status=0
output=$(cd "$work" && KENAF_RELAY=127.0.0.1:9 "$work/build/square" 2>&1) || status=$?
[ "$status" = 1 ] && grep -q relay <<<"$output" || fail "the other project's program ended with $status: $output"

! cmake "$work/build" -DBOTH=ON >"$work/log" 2>&1 || fail "CMake takes a program with both libraries"
grep -q KENAF_LIBRARY "$work/log" || { cat "$work/log"; fail "cmake failed for another reason"; }

echo "alone_test: configured with ${#hidden[@]} packages hidden; another project's program runs"

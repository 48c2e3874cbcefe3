#!/usr/bin/env bash
# A stranger's project uses what is installed, by find_package, by pkg-config and from Python.
#
#   consume.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"

# One program, built against one library; it must start, and fail for the right reason: nothing is there to drive.
expect_error() {
  local program=$1 words=$2 output status=0
  output=$(cd "$work" && KENAF_RELAY=127.0.0.1:9 "$program" 2>&1) || status=$?
  [ "$status" -gt 0 ] && [ "$status" -lt 126 ] || fail "$program ended with status $status: $output"
  grep -qi "$words" <<<"$output" || fail "$program did not say '$words': $output"
}

prefix=$work/prefix
cp -a "$installed" "$prefix"

mkdir "$work/project"
cp "$source/examples/square.c" "$work/project/square.c"
cat >"$work/project/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.20)
project(stranger C)
find_package(kenaf 0.1 REQUIRED)
add_library(square OBJECT square.c)
target_include_directories(square PRIVATE $<TARGET_PROPERTY:kenaf::sim,INTERFACE_INCLUDE_DIRECTORIES>)
foreach(library sim real)
  add_executable(square_${library} $<TARGET_OBJECTS:square>)
  target_link_libraries(square_${library} PRIVATE kenaf::${library})
endforeach()
PROJECT
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$prefix" >"$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; fail "find_package"; }
cmake --build "$work/project/build" >"$work/build.log" 2>&1 || { cat "$work/build.log"; fail "the stranger's build"; }
expect_error "$work/project/build/square_sim" relay
expect_error "$work/project/build/square_real" can
# The library finds the robots that were installed with it, from a program that was not.
sed 's/^interface = .*/interface = "stranger0"/' "$source/share/robots/kenaf.toml" >"$prefix/share/kenaf/robots/stranger.toml"
KENAF_ROBOT=stranger expect_error "$work/project/build/square_real" "no SocketCAN\|'stranger0'"

# The Python package, if the build has it: its library and its data are those that were installed with it.
module=$(dirname "$(find "$prefix/lib" -path '*dist-packages/kenaf/__init__.py')")
if [ -e "$module/__init__.py" ]; then
  libraries=$(dirname "$(find "$prefix" -name 'libkenaf_sim.so')")
  python() { PYTHONPATH=$(dirname "$module") LD_LIBRARY_PATH=$libraries /usr/bin/python3 -B "$@"; }
  [ "$(cd "$work" && python -c 'import kenaf; print(kenaf.simulate("straight").succeeded)')" = True ] ||
    fail "the installed Python package does not simulate"
  expect_error_of_square() { (cd "$work" && KENAF_LIBRARY=$1 KENAF_RELAY=127.0.0.1:9 python "$source/examples/python/square.py") 2>&1; }
  grep -q relay <<<"$(expect_error_of_square sim)" || fail "the Python square does not say 'relay'"
  grep -qi can <<<"$(expect_error_of_square real)" || fail "the Python square does not say 'CAN'"
fi

pkgconfig=$(dirname "$(find "$prefix" -name kenaf-sim.pc)")
for library in sim real; do
  read -ra flags <<<"$(PKG_CONFIG_PATH=$pkgconfig pkg-config --cflags --libs "kenaf-$library")"
  cc -Wall -Werror "$source/examples/square.c" -o "$work/pc_$library" "${flags[@]}" -Wl,-rpath,"$(dirname "$pkgconfig")"
done
expect_error "$work/pc_sim" relay
expect_error "$work/pc_real" can

# The operator's programs can be built where they are installed, by the commands of their page.
documents=$prefix/share/doc/kenaf
sed -n '/^shared=/,/^```/p' "$documents/docs/operator.md" | grep -v '^```' >"$work/commands"
grep -q operator_console "$work/commands" || fail "docs/operator.md does not say how its programs are built"
(cd "$documents/teleop" && PKG_CONFIG_PATH=$pkgconfig bash -e "$work/commands") >"$work/operator.log" 2>&1 ||
  { tail -n 30 "$work/operator.log"; fail "the operator's programs cannot be built as docs/operator.md says"; }

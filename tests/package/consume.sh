#!/usr/bin/env bash
# A stranger's project uses the installed package: by find_package, by pkg-config, and from the Debian package.
#
#   consume.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
server=
clean_up() {
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT
fail() { echo "consume: $*" >&2; exit 1; }
unset KENAF_DATA_DIR

# One program, built against one library; it must start, and fail for the right reason: nothing is there to drive.
expect_error() {
  local program=$1 words=$2 output status=0
  output=$(cd "$work" && KENAF_RELAY=127.0.0.1:9 "$program" 2>&1) || status=$?
  [ "$status" -gt 0 ] && [ "$status" -lt 126 ] || fail "$program ended with status $status: $output"
  grep -qi "$words" <<<"$output" || fail "$program did not say '$words': $output"
}

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
outside=$(grep -E '^-- (Installing|Up-to-date): ' "$work/install.log" | grep -vF ": $work/prefix/" || true)
[ -z "$outside" ] || fail "installed outside of the prefix: $outside"

# What is installed holds no path of the source tree, so it cannot need one.
holding=$(LC_ALL=C grep -rlaP "(?<![\w./-])\Q$source\E(?![\w.-])" "$work/prefix" || true)
[ -z "$holding" ] || fail "the source folder's path is in $holding"

mkdir "$work/project"
cp "$source/examples/square.c" "$work/project/square.c"
cat >"$work/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.20)
project(stranger C)
find_package(kenaf 0.1 REQUIRED)
add_library(square OBJECT square.c)
target_include_directories(square PRIVATE $<TARGET_PROPERTY:kenaf::sim,INTERFACE_INCLUDE_DIRECTORIES>)
foreach(library sim real)
  add_executable(square_${library} $<TARGET_OBJECTS:square>)
  target_link_libraries(square_${library} PRIVATE kenaf::${library})
endforeach()
END
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; fail "find_package"; }
cmake --build "$work/project/build" >"$work/build.log" 2>&1 || { cat "$work/build.log"; fail "the stranger's build"; }
expect_error "$work/project/build/square_sim" relay
expect_error "$work/project/build/square_real" can
# The library finds the robots that were installed with it, from a program that was not.
sed 's/^interface = .*/interface = "stranger0"/' "$source/robots/kenaf.toml" >"$work/prefix/share/kenaf/robots/stranger.toml"
KENAF_ROBOT=stranger expect_error "$work/project/build/square_real" "no SocketCAN\|'stranger0'"

pkgconfig=$(dirname "$(find "$work/prefix" -name kenaf-sim.pc)")
for library in sim real; do
  read -ra flags <<<"$(PKG_CONFIG_PATH=$pkgconfig pkg-config --cflags --libs "kenaf-$library")"
  cc -Wall -Werror "$source/examples/square.c" -o "$work/pc_$library" "${flags[@]}" -Wl,-rpath,"$(dirname "$pkgconfig")"
done
expect_error "$work/pc_sim" relay
expect_error "$work/pc_real" can

# The installed world server finds its robots and worlds.
(cd "$work" && exec "$work/prefix/bin/kenaf-world" --port 0 --port-file port --view off --cameras off) \
  >"$work/world.log" 2>&1 & server=$!
for _ in $(seq 100); do
  [ ! -s "$work/port" ] && kill -0 "$server" 2>/dev/null || break
  sleep 0.1
done
[ -s "$work/port" ] || { cat "$work/world.log"; fail "the installed world server does not start"; }
kill -TERM "$server"
wait "$server" || { cat "$work/world.log"; fail "the installed world server does not stop"; }
server=

(cd "$work" && cpack --config "$build/CPackConfig.cmake" -B "$work" >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; fail "cpack"; }
package=$(ls "$work"/kenaf_*.deb)
dpkg-deb --fsys-tarfile "$package" | tar -t >"$work/contents"
! grep -vE '^\./(usr/.*)?$' "$work/contents" || fail "the package installs outside of /usr"
for file in bin/kenaf-world bin/kenaf-relayd bin/kenaf-draw bin/kenaf-canlog bin/kenaf-candrives bin/kenaf-gap include/kenaf/hrt.h \
            share/kenaf/robots/kenaf.toml share/kenaf/worlds/flat.sdf \
            share/kenaf/page/index.html share/kenaf/page/three/three.module.js share/kenaf/page/three/OrbitControls.js \
            lib/systemd/system/kenaf-relayd.service lib/systemd/system/kenaf-world.service \
            "lib/(.*/)?libkenaf_sim\.so\.1" "lib/(.*/)?libkenaf_real\.so\.1" "lib/(.*/)?kenafConfig.cmake" "lib/(.*/)?kenaf-sim.pc"; do
  grep -qxE "\./usr/$file" "$work/contents" || { cat "$work/contents"; fail "$file is not in the package"; }
done
# The units start what the package installs.
dpkg-deb -x "$package" "$work/root"
for unit in "$work"/root/usr/lib/systemd/system/*.service; do
  program=$(sed -n 's/^ExecStart=\([^ ]*\).*/\1/p' "$unit")
  [[ $program != */* && -x $work/root/usr/bin/$program ]] || fail "$(basename "$unit") starts $program"
done
depends=$(dpkg-deb --field "$package" Depends)
for library in libbullet libturbojpeg0; do
  grep -q "$library" <<<"$depends" || fail "the package does not depend on $library"
done
echo "consume: find_package, pkg-config and $(basename "$package") work"

#!/usr/bin/env bash
# A stranger's project uses the installed package, by find_package and by pkg-config; the installed programs run without
# the source tree; the Debian packages hold what each is for, and bring what it needs.
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

prefix=$work/prefix
cmake --install "$build" --prefix "$prefix" >"$work/install.log"
outside=$(grep -E '^-- (Installing|Up-to-date): ' "$work/install.log" | grep -vF ": $prefix/" || true)
[ -z "$outside" ] || fail "installed outside of the prefix: $outside"
(cd "$prefix" && find . ! -type d | sort) >"$work/installed"

# What is installed holds no path of the source tree, so it cannot need one.
holding=$(LC_ALL=C grep -rlaP "(?<![\w./-])\Q$source\E(?![\w.-])" "$prefix" || true)
[ -z "$holding" ] || fail "the source folder's path is in $holding"

programs=(kenaf-candrives kenaf-canlog kenaf-describe kenaf-draw kenaf-relayd kenaf-world)
for program in kenaf-gap kenaf-gap-mpi; do  # a build may be without them
  [ ! -e "$prefix/bin/$program" ] || programs+=("$program")
done
version=$("$prefix/bin/kenaf-world" --version) || fail "kenaf-world does not tell its version"
for program in "${programs[@]}"; do
  [ "$("$prefix/bin/$program" --version)" = "$version" ] || fail "$program is not of version $version"
  grep -q version "$prefix/share/man/man1/$program.1" || fail "$program has no manual page"
done

# The installed world server finds its robots and worlds.
(cd "$work" && exec "$prefix/bin/kenaf-world" --port 0 --port-file port --view off --cameras off --log-level warning) \
  >"$work/world.log" 2>&1 & server=$!
for _ in $(seq 100); do
  [ ! -s "$work/port" ] && kill -0 "$server" 2>/dev/null || break
  sleep 0.1
done
[ -s "$work/port" ] || { cat "$work/world.log"; fail "the installed world server does not start"; }
kill -TERM "$server"
wait "$server" || { cat "$work/world.log"; fail "the installed world server does not stop"; }
server=

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

# The Debian packages
(cd "$work" && cpack --config "$build/CPackConfig.cmake" -B "$work" >"$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; fail "cpack"; }
abi=$(sed -n 's/^#define HRT_ABI //p' "$source/include/kenaf/hrt.h")
library=libkenaf$abi
packages=("$library" libkenaf-dev kenaf-data kenaf)
[ ! -e "$prefix/bin/kenaf-gap-mpi" ] || packages+=(kenaf-gap-mpi)
[ ! -e "$module/__init__.py" ] || packages+=(python3-kenaf)
deb() { ls "$work/$1"_*.deb; }
files() { cat "$work/$1.files"; }
field() { dpkg-deb --field "$(deb "$1")" "$2"; }
for package in "${packages[@]}"; do
  [ -f "$(deb "$package")" ] || fail "there is no package $package"
  dpkg-deb --fsys-tarfile "$(deb "$package")" | tar -t >"$work/$package.files"
  ! files "$package" | grep -vE '^\./(usr/.*)?$' || fail "$package installs outside of /usr"
  files "$package" | grep -qxF "./usr/share/doc/$package/copyright" || fail "$package has no copyright"
  [ "$(field "$package" Version)" = "$version" ] || fail "$package is not of version $version"
  dpkg-deb -x "$(deb "$package")" "$work/root"
done

# Whatever `cmake --install` installs is in one of them.
for package in "${packages[@]}"; do files "$package"; done | grep -v '/$' | sed 's#^\./usr/#./#' | sort >"$work/packed"
diff "$work/installed" "$work/packed" || fail "the packages hold other files than cmake --install installs"

holds() {  # PACKAGE PATTERN...
  local package=$1 pattern; shift
  for pattern in "$@"; do
    files "$package" | grep -qxE "\./usr/$pattern" || { files "$package"; fail "$pattern is not in $package"; }
  done
}
holds "$library" "lib/(.*/)?libkenaf_sim\.so\.$abi" "lib/(.*/)?libkenaf_real\.so\.$abi"
holds libkenaf-dev include/kenaf/hrt.h "lib/(.*/)?libkenaf_sim\.so" "lib/(.*/)?libkenaf_real\.so" \
  "lib/(.*/)?cmake/kenaf/kenafConfig.cmake" "lib/(.*/)?pkgconfig/kenaf-sim.pc" "lib/(.*/)?pkgconfig/kenaf-real.pc"
holds kenaf-data share/kenaf/robots/kenaf.toml share/kenaf/worlds/flat.sdf share/kenaf/manoeuvres/turn.toml
holds kenaf bin/kenaf-world bin/kenaf-relayd bin/kenaf-describe bin/kenaf-draw bin/kenaf-canlog bin/kenaf-candrives \
  share/man/man1/kenaf-world.1 lib/systemd/system/kenaf-relayd.service lib/systemd/system/kenaf-world.service \
  share/kenaf/page/index.html share/kenaf/page/three/three.module.js share/kenaf/page/three/OrbitControls.js \
  share/doc/kenaf/README.md share/doc/kenaf/docs/user-guide.md share/doc/kenaf/examples/square.c share/doc/kenaf/examples/python/square.py \
  share/doc/kenaf/include/kenaf/hrt.h
[ ! -e "$prefix/bin/kenaf-gap" ] || holds kenaf bin/kenaf-gap share/man/man1/kenaf-gap.1
[ ! -e "$prefix/bin/kenaf-gap-mpi" ] || holds kenaf-gap-mpi bin/kenaf-gap-mpi share/man/man1/kenaf-gap-mpi.1

[ ! -e "$module/__init__.py" ] || holds python3-kenaf "lib/python3\.[0-9]+/dist-packages/kenaf/__init__\.py" \
  "lib/python3\.[0-9]+/dist-packages/kenaf/(_core|hrt_sim|hrt_real)\..*\.so" "lib/python3\.[0-9]+/dist-packages/kenaf/py\.typed"

# The units start what the packages install.
for unit in "$work"/root/usr/lib/systemd/system/*.service; do
  program=$(sed -n 's/^ExecStart=\([^ ]*\).*/\1/p' "$unit")
  [[ $program != */* && -x $work/root/usr/bin/$program ]] || fail "$(basename "$unit") starts $program"
done

needs() {  # PACKAGE WORDS...
  local package=$1 words depends; shift
  depends=$(field "$package" Depends)
  for words in "$@"; do
    grep -qF "$words" <<<"$depends" || fail "$package does not depend on $words, but on $depends"
  done
}
# A robot's computer gets neither physics nor cameras.
needs "$library" "kenaf-data (>= $version)" libturbojpeg0
! field "$library" Depends | grep -E 'libbullet|libembree|libopenmpi' || fail "$library brings too much"
control() { dpkg-deb --ctrl-tarfile "$(deb "$1")" | tar -xO "./$2"; }
grep -q ldconfig <<<"$(control "$library" triggers)" || fail "$library does not call ldconfig"
# Another's package of a program on one of the libraries gets its dependency from this.
for name in libkenaf_sim libkenaf_real; do
  grep -qxF "$name $abi $library (>= $version)" <<<"$(control "$library" shlibs)" ||
    fail "$library does not say which package $name is in"
done
needs libkenaf-dev "$library (= $version)"
needs kenaf "kenaf-data (= $version)" libbullet libturbojpeg0
! field kenaf Depends | grep libopenmpi || fail "kenaf brings OpenMPI"
[ ! -e "$prefix/bin/kenaf-gap-mpi" ] || needs kenaf-gap-mpi "kenaf-data (= $version)"
[ ! -e "$module/__init__.py" ] || needs python3-kenaf "kenaf-data (= $version)" "$library (= $version)" "python3 (<<" python3-numpy
[ "$(field kenaf-data Architecture)" = all ] || fail "kenaf-data is not for all architectures"

echo "consume: find_package, pkg-config and ${packages[*]} work"

#!/usr/bin/env bash
# Builds both libraries for 64-bit ARM, and drives the square example, which is for ARM then, by qemu against the simulator
# of this machine.
#
#   scripts/try-aarch64.sh     exit status 0: the square closed within 10 mm and 2 degrees
#
# Needs g++-aarch64-linux-gnu, qemu-user-static, and what scripts/install-dependencies.sh build installs. What the libraries need
# is taken from Debian's packages into build/aarch64; nothing is installed. RELAYD_FOLDER: a folder that has kenaf-relayd, else it
# is built. DEBIAN_MIRROR: of Debian's packages (default: this machine's first).
set -euo pipefail
cd "$(dirname "$0")/.."
out=$PWD/build/aarch64
bin=${RELAYD_FOLDER:-$PWD/build/install/bin}
mkdir -p "$out"
step() { printf '\n== %s (%d s so far)\n' "$*" "$SECONDS"; }
fail() { printf 'try-aarch64: %s\n' "$*" >&2; exit 1; }
quietly() {  # LOG COMMAND...
  local log=$out/$1; shift
  "$@" >"$log" 2>&1 || { tail -n 60 "$log"; fail "'$*' failed; its whole output is $log"; }
}
for tool in aarch64-linux-gnu-g++ qemu-aarch64-static; do
  command -v "$tool" >/dev/null || fail "$tool is not installed (packages g++-aarch64-linux-gnu, qemu-user-static)"
done

step "what the libraries need, for ARM"
mirror=${DEBIAN_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | sed -n 1p)}
# An apt of its own: this machine's need not know that architecture.
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
mkdir -p "$out/apt/lists/partial" "$out/apt/cache/archives/partial"
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $release main" >"$out/apt/sources.list"
apt=(apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State::lists="$out/apt/lists"
  -o Dir::State::status=/dev/null -o Dir::Cache="$out/apt/cache" -o Dir::Etc::SourceList="$out/apt/sources.list"
  -o Dir::Etc::SourceParts=/dev/null)
rm -f "$out"/*.deb
quietly apt.log "${apt[@]}" update
(cd "$out" && quietly apt.log "${apt[@]}" download libfmt-dev libfmt9 libtomlplusplus-dev libturbojpeg0 libturbojpeg0-dev)
for package in "$out"/*.deb; do dpkg-deb -x "$package" "$out/root"; done

step "both libraries and the examples for ARM"
lib=$out/root/usr/lib/aarch64-linux-gnu
emulator=(qemu-aarch64-static -L /usr/aarch64-linux-gnu)
quietly library.log cmake -S . -B "$out/library" -DCMAKE_BUILD_TYPE=Release -DKENAF_COMPILE_TOGETHER=ON \
  -DKENAF_BUILD_SIMULATOR=OFF -DKENAF_BUILD_TESTS=OFF -DKENAF_BUILD_EXAMPLES=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_Curses=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
  -Dfmt_DIR="$lib/cmake/fmt" -DKENAF_TOML_FOLDER="$out/root/usr/include" \
  -DKENAF_TURBOJPEG_FOLDER="$out/root/usr/include" -DKENAF_TURBOJPEG_LIBRARY="$lib/libturbojpeg.so"
quietly library.log cmake --build "$out/library" -j "$(nproc)"
for library in sim real; do
  file=$out/library/lib/libkenaf_$library.so
  readelf -h "$file" | grep -q AArch64 || fail "$file is not for ARM"
  echo "libkenaf_$library.so: AArch64, needs" $(readelf -d "$file" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
done

step "the square"
if [ -z "${RELAYD_FOLDER:-}" ]; then
  quietly relayd.log cmake --preset install
  quietly relayd.log cmake --build --preset install --target kenaf-relayd
fi
rm -f "$out/port" "$out/square.csv"
"$bin/kenaf-relayd" --embedded --view off --cameras off --listen 127.0.0.1:0 --port-file "$out/port" >"$out/relay.log" 2>&1 &
relay=$!
trap 'kill "$relay" 2>/dev/null || true; wait "$relay" || true' EXIT
until [ -s "$out/port" ]; do
  kill -0 "$relay" 2>/dev/null || { cat "$out/relay.log" >&2; fail "the relay did not start"; }
  sleep 0.1
done
run() { "${emulator[@]}" -E LD_LIBRARY_PATH="$lib:$out/library/lib" "$@"; }
KENAF_RELAY="127.0.0.1:$(cat "$out/port")" KENAF_RECORD="$out/square.csv" run "$out/library/bin/square_sim" ||
  fail "the square failed"
closes=yes
said=$(scripts/closing-error.sh "$out/square.csv") || closes=no
echo "try-aarch64: $said"
[ "$closes" = yes ] || fail "the square did not close within 10 mm and 2 degrees"
status=0
output=$(KENAF_CAN_INTERFACE=nocan7 KENAF_ROBOT="$PWD/share/robots/kenaf.toml" run "$out/library/bin/square_real" 2>&1) || status=$?
[ "$status" = 1 ] && grep -qi can <<<"$output" || fail "square_real ended with $status: $output"
echo "try-aarch64: square_real, without a bus, says: $output"
step "passed"

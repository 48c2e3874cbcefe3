#!/usr/bin/env bash
# Installs what is missing of the Debian packages that Kenaf needs. docs/developing.md says what each is for.
#
#   scripts/install-dependencies.sh                  to build, test and package
#   scripts/install-dependencies.sh build            only to build, install and package, and to run the demo
#   scripts/install-dependencies.sh tests            as build, and to run the tests; without sanitizers and the CAN bus
#   scripts/install-dependencies.sh library          only the two libraries (-DKENAF_BUILD_SIMULATOR=OFF)
#   scripts/install-dependencies.sh library-tests    the same with their tools, tests and packages
#   scripts/install-dependencies.sh bench            as without, and the engines that the benchmark compares with, and load
set -euo pipefail

library=(cmake g++ make libfmt-dev libtomlplusplus-dev libturbojpeg0-dev)
packages=(
  "${library[@]}" ninja-build pkg-config
  libassimp-dev libboost-dev libboost-system-dev libbullet-dev libbz2-dev libcairo2-dev libcli11-dev libeigen3-dev libembree-dev libexpat1-dev
  libjs-three liblz4-dev libncurses-dev libpng-dev libspdlog-dev libsqlite3-dev libtinyxml2-dev
  liburdfdom-dev libzstd-dev nettle-dev nlohmann-json3-dev zlib1g-dev
  # the Python package
  pybind11-dev python3-dev python3-numpy
  # the package
  dpkg-dev file help2man python3
)
# The same on every release of Debian.
tests=(abigail-tools binutils catch2 chromium-headless-shell git iproute2 liburdfdom-tools mypy python3)
mode=${1:-all}
case $mode in
  library) packages=("${library[@]}") ;;
  library-tests) packages=("${library[@]}" abigail-tools catch2 dpkg-dev file libcli11-dev libncurses-dev) ;;
  build) ;;
  tests) packages+=("${tests[@]}") ;;
  all | bench)
    packages+=(
      "${tests[@]}" clang clang-format clang-tidy libclang-rt-14-dev llvm
      # tests of the package
      groff-base lintian zsh
      # the CAN tests
      busybox-static can-utils cpio kmod qemu-system-x86 xz-utils
      # a diagnosis by several processes
      libopenmpi-dev openmpi-bin
    )
    if [ "$mode" = bench ]; then packages+=(libmujoco-dev libode-dev stress); fi
    ;;
  *) echo "install-dependencies: '$mode' is neither 'library', 'library-tests', 'build', 'tests', 'bench' nor nothing" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "install-dependencies: these packages are missing and there is no sudo to install them; run as root:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "install-dependencies: installing ${missing[*]}"
log=$(mktemp)
if ! { "${as_root[@]}" apt-get update &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install --yes --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  cat "$log" >&2
  echo "install-dependencies: apt-get failed, its output is above" >&2
  exit 1
fi
rm -f "$log"

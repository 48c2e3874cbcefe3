#!/usr/bin/env bash
# Builds and tests Kenaf on a fresh Debian, as a user who has installed nothing but what it needs.
#
#   scripts/try-debian.sh bookworm|trixie [library|whole]     default: library
#
#   library   the two libraries without the simulator: on a machine with g++, cmake and what they need alone; then with their
#             tools, tests and packages, which go to build/debian/RELEASE; then, on trixie, those packages that bookworm
#             made, if they are there
#   whole     the same, and everything else with its tests (about an hour)
#
# Needs root, or sudo, and debootstrap; 1 GB of disk for the libraries, 6 GB for the whole, below CHROOTS
# (/var/tmp/kenaf-chroots). The folder is removed at the end, unless CHROOTS is set. DEBIAN_MIRROR: of Debian's
# packages. JOBS: how many compilers at once (all cores).
set -euo pipefail
cd "$(dirname "$0")/.."
release=${1:-} part=${2:-library}
case $release in bookworm | trixie) ;; *) echo "try-debian: '$release' is neither 'bookworm' nor 'trixie'" >&2; exit 2 ;; esac
case $part in library | whole) ;; *) echo "try-debian: '$part' is neither 'library' nor 'whole'" >&2; exit 2 ;; esac
command -v debootstrap >/dev/null || { echo "try-debian: install debootstrap" >&2; exit 2; }
as_root=()
[ "$(id -u)" = 0 ] || as_root=(sudo)
mirror=${DEBIAN_MIRROR:-}  # empty: the one that debootstrap has
root=${CHROOTS:-/var/tmp/kenaf-chroots}/$release
jobs=${JOBS:-$(nproc)}
home=/home/kenaf/kenaf  # of the source, in the chroot
out=$PWD/build/debian/$release
mkdir -p "$out"

step() { printf '\n== %s: %s (%d s so far)\n' "$release" "$*" "$SECONDS"; }
fail() { printf 'try-debian: %s\n' "$*" >&2; exit 1; }
in_root() { "${as_root[@]}" chroot "$root" "$@"; }
as_user() {  # FOLDER COMMAND...
  "${as_root[@]}" chroot --userspec=kenaf "$root" /usr/bin/env -i HOME=/home/kenaf PATH=/usr/bin:/bin LC_ALL=C.UTF-8 \
    sh -c 'cd "$1" && shift && exec "$@"' sh "$@"
}
quietly() {  # LOG COMMAND...
  local log=$out/$1; shift
  "$@" >"$log" 2>&1 || { tail -n 60 "$log"; fail "'$*' failed; its whole output is $log"; }
}
mounted=
clean_up() {
  [ -z "$mounted" ] || "${as_root[@]}" umount "$root/proc" "$root/dev/shm" "$root/dev/pts" || true
  [ -n "${CHROOTS:-}" ] || "${as_root[@]}" rm -rf --one-file-system "$root"
}
trap clean_up EXIT

step "debootstrap"
[ -e "$root/etc/debian_version" ] || quietly debootstrap.log "${as_root[@]}" debootstrap --variant=minbase "$release" "$root" ${mirror:+"$mirror"}
"${as_root[@]}" mount -t proc proc "$root/proc"
"${as_root[@]}" mkdir -p "$root/dev/shm" "$root/dev/pts"
"${as_root[@]}" mount -t tmpfs tmpfs "$root/dev/shm"
"${as_root[@]}" mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts "$root/dev/pts"
"${as_root[@]}" ln -sf pts/ptmx "$root/dev/ptmx"
mounted=yes
printf '127.0.0.1 localhost\n::1 localhost ip6-localhost ip6-loopback\n' | in_root tee /etc/hosts >/dev/null  # as of every installation
in_root id kenaf >/dev/null 2>&1 || in_root useradd --create-home kenaf
"${as_root[@]}" rm -rf "$root$home"
in_root mkdir -p "$home"
git ls-files -z | tar -c --null -T - | "${as_root[@]}" tar -x -C "$root$home"
in_root chown -R kenaf: "$home"
in_root sh -c '. /etc/os-release; echo "$PRETTY_NAME"'

# A square against one of the libraries that are installed: it starts, and fails for the right reason.
square_fails_rightly() {
  as_user "$home" sh -c 'cc examples/square.c -o /home/kenaf/square -lkenaf_sim && ! KENAF_RELAY=127.0.0.1:9 /home/kenaf/square' \
    >"$out/square.log" 2>&1 && grep -q relay "$out/square.log" || { cat "$out/square.log"; fail "the square does not ask for a relay"; }
}
if [ "$release" != bookworm ] && ls "$out"/../bookworm/libkenaf*.deb >/dev/null 2>&1; then
  step "the packages that bookworm made"
  quietly packages.log in_root apt-get install --yes --no-install-recommends gcc libc6-dev
  "${as_root[@]}" cp "$out"/../bookworm/*.deb "$root/tmp"
  quietly packages.log in_root sh -c 'apt-get install --yes --no-install-recommends /tmp/libkenaf*.deb /tmp/kenaf-data_*.deb'
  square_fails_rightly
  quietly packages.log in_root sh -c 'apt-get remove --yes libkenaf-dev kenaf-data "libkenaf[0-9]*" && rm /tmp/*.deb'
  echo "try-debian: a program on them starts"
fi

step "the libraries, with g++, cmake and what they need"
quietly apt.log in_root "$home/scripts/install-dependencies.sh" library
as_user "$home" g++ --version | head -n 1
quietly library.log as_user "$home" cmake -S . -B library -DKENAF_BUILD_SIMULATOR=OFF -DCMAKE_BUILD_TYPE=Release -DKENAF_COMPILE_TOGETHER=ON
quietly library.log as_user "$home" cmake --build library -j "$jobs"
quietly tests.log as_user "$home" ctest --test-dir library -LE release-only --output-on-failure
grep 'tests passed' "$out/tests.log"

step "the libraries, with their tools, tests and packages"
quietly apt.log in_root "$home/scripts/install-dependencies.sh" library-tests
quietly library.log as_user "$home" cmake library
quietly library.log as_user "$home" cmake --build library -j "$jobs"
quietly tests.log as_user "$home" ctest --test-dir library -LE release-only -j "$((jobs + 2))" --output-on-failure
grep 'tests passed' "$out/tests.log"
quietly cpack.log as_user "$home/library" cpack
rm -f "$out"/*.deb
cp "$root$home"/library/*.deb "$out"
for package in "$out"/libkenaf[0-9]*.deb; do
  echo "$(basename "$package") depends on $(dpkg-deb --field "$package" Depends)"
done
quietly packages.log in_root sh -c "apt-get install --yes --no-install-recommends $home/library/*.deb"
square_fails_rightly
echo "try-debian: a program on the packages starts"
quietly packages.log in_root sh -c 'apt-get remove --yes libkenaf-dev kenaf-data "libkenaf[0-9]*"'

if [ "$part" = whole ]; then
  step "everything"
  quietly apt.log in_root "$home/scripts/install-dependencies.sh" tests
  quietly whole.log as_user "$home" cmake --preset release
  quietly whole.log as_user "$home" cmake --build --preset release -j "$jobs"
  quietly whole-tests.log as_user "$home" ctest --preset release -LE release-only -j "$((jobs + 2))"
  grep 'tests passed' "$out/whole-tests.log"
fi
step "passed"

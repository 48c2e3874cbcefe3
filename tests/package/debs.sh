#!/usr/bin/env bash
# The Debian packages hold what each is for, and bring what it needs.
#
#   debs.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
abi=$(sed -n 's/^#define HRT_ABI //p' "$source/include/kenaf/hrt.h")
library=libkenaf$abi
triplet=$(cc -print-multiarch)
version=$("$installed/bin/kenaf-world" --version)-1
packages=("$library" libkenaf-dev kenaf-data kenaf)
[ ! -e "$installed/bin/operator_console" ] || packages+=(kenaf-operator)
[ ! -e "$installed/bin/kenaf-gap-mpi" ] || packages+=(kenaf-gap-mpi)
has_python=$(find "$installed/lib" -path '*dist-packages/kenaf/__init__.py')
[ -z "$has_python" ] || packages+=(python3-kenaf)
deb() { ls "$debs/$1"_*.deb; }
files() { cat "$work/$1.files"; }
field() { dpkg-deb --field "$(deb "$1")" "$2"; }
for package in "${packages[@]}"; do
  [ -f "$(deb "$package")" ] || fail "there is no package $package"
  dpkg-deb --fsys-tarfile "$(deb "$package")" | tar -t >"$work/$package.files"
  ! files "$package" | grep -vE '^\./(usr/.*)?$' || fail "$package installs outside of /usr"
  for document in copyright changelog.gz changelog.Debian.gz; do
    grep -qxF "./usr/share/doc/$package/$document" "$work/$package.files" || fail "$package has no $document"
  done
  [ "$(field "$package" Version)" = "$version" ] || fail "$package is not of version $version"
  dpkg-deb -x "$(deb "$package")" "$work/root"
done

# Whatever `cmake --install` installs is in one of them, under the names that Debian has for it (DebianStaging.cmake).
(cd "$installed" && find . ! -type d) |
  sed -E 's#^(\./share/man/.*)#\1.gz#; s#^\./lib/python3\.[0-9]+/#./lib/python3/#; s#/zsh/site-functions/#/zsh/vendor-completions/#; s#^\./share/kenaf/three/.*#./share/kenaf/three#' |
  sort -u >"$work/expected"
for package in "${packages[@]}"; do files "$package"; done | grep -v '/$' | sed 's#^\./usr/#./#' |
  grep -vE '^\./share/(doc/[^/]*/changelog(\.Debian)?\.gz|lintian/overrides/.*)$' | sort >"$work/packed"
diff "$work/expected" "$work/packed" || fail "the packages hold other files than cmake --install installs"

# A link leads into the same package, or to what it depends on.
[ "$(readlink "$work/root/usr/share/kenaf/three")" = ../javascript/three ] || fail "three.js is not that of libjs-three"
rm "$work/root/usr/share/kenaf/three"
dangling=$(find "$work/root" -type l ! -exec test -e {} \; -print)
[ -z "$dangling" ] || fail "these links lead nowhere: $dangling"

holds() {  # PACKAGE PATTERN...
  local package=$1 pattern; shift
  for pattern in "$@"; do
    grep -qxE "\./usr/$pattern" "$work/$package.files" || { files "$package"; fail "$pattern is not in $package"; }
  done
}
holds "$library" "lib/$triplet/libkenaf_sim\.so\.$abi" "lib/$triplet/libkenaf_real\.so\.$abi"
holds libkenaf-dev include/kenaf/hrt.h "lib/$triplet/libkenaf_sim\.so" "lib/$triplet/libkenaf_real\.so" \
  "lib/$triplet/cmake/kenaf/kenafConfig.cmake" "lib/$triplet/pkgconfig/kenaf-sim.pc" "lib/$triplet/pkgconfig/kenaf-real.pc" \
  share/man/man3/hrt.3.gz share/man/man3/hrt_go_forward.3.gz
holds kenaf-data share/man/man5/kenaf.toml.5.gz share/kenaf/robots/kenaf.toml share/kenaf/worlds/flat.sdf share/kenaf/manoeuvres/turn.toml
holds kenaf bin/kenaf-world bin/kenaf-relayd bin/kenaf-describe bin/kenaf-draw bin/kenaf-canlog bin/kenaf-candrives \
  share/man/man1/kenaf-world.1.gz share/bash-completion/completions/kenaf-world share/zsh/vendor-completions/_kenaf-world \
  lib/systemd/system/kenaf-relayd.service lib/systemd/system/kenaf-world.service \
  share/kenaf/page/index.html share/kenaf/three \
  share/doc/kenaf/README.md share/doc/kenaf/docs/user-guide.md share/doc/kenaf/examples/square.c share/doc/kenaf/examples/python/square.py \
  share/doc/kenaf/include/kenaf/hrt.h
[ ! -e "$installed/bin/kenaf-gap" ] || holds kenaf bin/kenaf-gap share/man/man1/kenaf-gap.1.gz
[ ! -e "$installed/bin/kenaf-gap-mpi" ] || holds kenaf-gap-mpi bin/kenaf-gap-mpi share/man/man1/kenaf-gap-mpi.1.gz
[ ! -e "$installed/bin/operator_console" ] || holds kenaf-operator bin/operator_console bin/operator_control_real \
  bin/operator_control_sim share/man/man1/operator_console.1.gz share/bash-completion/completions/operator_console
[ -z "$has_python" ] || holds python3-kenaf "lib/python3/dist-packages/kenaf/__init__\.py" \
  "lib/python3/dist-packages/kenaf/(_core|hrt_sim|hrt_real)\..*\.so" "lib/python3/dist-packages/kenaf/py\.typed"

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
needs "$library" "kenaf-data (>= ${version%-*})" libturbojpeg0
! field "$library" Depends | grep -E 'libbullet|libembree|libopenmpi' || fail "$library brings too much"
control() { dpkg-deb --ctrl-tarfile "$(deb "$1")" | tar -xO "./$2"; }
grep -q ldconfig <<<"$(control "$library" triggers)" || fail "$library does not call ldconfig"
# Another's package of a program on one of the libraries gets its dependency from this.
for name in libkenaf_sim libkenaf_real; do
  grep -qxF "$name $abi $library (>= ${version%-*})" <<<"$(control "$library" shlibs)" ||
    fail "$library does not say which package $name is in"
done
needs libkenaf-dev "$library (= $version)"
needs kenaf "kenaf-data (= $version)" libbullet libturbojpeg0 libjs-three
! field kenaf Depends | grep libopenmpi || fail "kenaf brings OpenMPI"
[ ! -e "$installed/bin/kenaf-gap-mpi" ] || needs kenaf-gap-mpi "kenaf-data (= $version)"
[ ! -e "$installed/bin/operator_console" ] || needs kenaf-operator "$library (= $version)" libncurses
[ -z "$has_python" ] || needs python3-kenaf "kenaf-data (= $version)" "$library (= $version)" "python3 (<<" python3-numpy
[ "$(field kenaf-data Architecture)" = all ] || fail "kenaf-data is not for all architectures"

# The services are stopped before their program goes, and run the new one after an upgrade.
for script in postinst prerm postrm; do
  control kenaf "$script" >"$work/$script"
  sh -n "$work/$script" || fail "$script of kenaf is no shell script"
  for unit in kenaf-world kenaf-relayd; do
    grep -q "$unit.service" "$work/$script" || fail "$script of kenaf leaves out $unit"
  done
done

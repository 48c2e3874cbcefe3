#!/usr/bin/env bash
# Makes what the virtual machine of with-vcan.sh starts from, and prints its folder: vmlinux and initramfs.cpio.
#
# Kept in ${XDG_CACHE_HOME:-~/.cache}/kenaf/vcan, one folder per kernel package; nothing is installed. The package is
# the newest that apt knows when the folder is first made, or the file that KENAF_VCAN_KERNEL_DEB names; to take a
# newer one, delete the folder. Debian's cloud kernel has no CAN, so it is the ordinary one.
set -Eeuo pipefail
here=$(cd "$(dirname "$0")" && pwd)
modules=(virtio_pci 9pnet_virtio 9p overlay can-raw can-bcm vcan)
camera_modules=(vivid)   # loaded by --camera alone
work=''
trap '[ -z "$work" ] || rm -rf "$work"' EXIT
trap 'echo "with-vcan: ${BASH_SOURCE[0]}: line $LINENO failed" >&2' ERR
fail() { printf 'with-vcan: %s\n' "$*" >&2; exit 1; }

[ "$(uname -m)" = x86_64 ] || fail "the virtual machine is an x86_64, this machine is a $(uname -m)"
missing=()
needs() { command -v "$1" >/dev/null || missing+=("$2"); }
needs qemu-system-x86_64 qemu-system-x86
needs cpio cpio
needs depmod kmod
needs ip iproute2
needs xz xz-utils
needs dpkg-deb dpkg
{ command -v busybox && ! ldd "$(command -v busybox)"; } >/dev/null 2>&1 || missing+=(busybox-static)
[ ${#missing[@]} = 0 ] || fail "missing for the virtual machine: apt-get install --no-install-recommends ${missing[*]}"

[ -n "${XDG_CACHE_HOME:-${HOME:-}}" ] || fail "neither HOME nor XDG_CACHE_HOME is set; the kernel is kept below them"
cache=${XDG_CACHE_HOME:-$HOME/.cache}/kenaf/vcan
mkdir -p "$cache"
exec 9>"$cache/lock"
flock 9
rm -rf "$cache"/making.*   # of a run that was killed
work=$(mktemp -d "$cache/making.XXXXXX")

# Downloads the package into $work and names it. Without apt's lists, which containers often lack, it fetches lists of
# its own: that needs no rights and leaves apt's as they are.
download() {
  local options=(-o APT::Sandbox::User=root -o Debug::NoLocking=1) package log=$work/apt.log
  find_package() {
    package=$(apt-cache "${options[@]}" depends --important linux-image-amd64 2>>"$log" | awk '/Depends:/ { print $2; exit }')
    [ -n "$package" ] && (cd "$work" && apt-get "${options[@]}" download "$package") >>"$log" 2>&1
  }
  if ! find_package; then
    mkdir -p "$work/state/lists/partial" "$work/cache/archives/partial"
    options+=(-o "Dir::State::Lists=$work/state/lists" -o "Dir::Cache=$work/cache")
    apt-get "${options[@]}" update >>"$log" 2>&1 && find_package || {
      cat "$log" >&2
      fail "cannot download linux-image-amd64: apt's words are above; KENAF_VCAN_KERNEL_DEB=FILE takes a file instead"
    }
  fi
  echo "$work"/linux-image-*.deb
}

# The kernel as an ELF file. Started as such, the machine need not unpack it: 2.4 s less where it is emulated. Offsets:
# "The Linux/x86 Boot Protocol", fields setup_sects, payload_offset, payload_length (whose last 4 bytes are a size).
extract_vmlinux() {
  local image=$1 start length
  number() { od -An -t "u$2" -j "$1" -N "$2" "$image" | tr -d ' '; }
  start=$((($(number 0x1f1 1) + 1) * 512 + $(number 0x248 4)))
  length=$(($(number 0x24c 4) - 4))
  dd if="$image" iflag=skip_bytes,count_bytes skip="$start" count="$length" bs=1M status=none | xz -dc
}

# The files of the modules named after FILE and of all that they need, in the order of loading: their names in FILE.
copy_modules() {
  local tree=$1 release=$2 order=$3 module; shift 3
  for module; do
    modprobe -d "$tree" -S "$release" --show-depends "$module" || fail "$package has no module $module"
  done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }' >"$work/files"
  xargs cp -t "$work/kernel/modules" <"$work/files"
  sed 's,.*/,,' "$work/files" >"$order"
}

# $work/kernel: vmlinux, modules/, with modules/order and modules/camera-order.
unpack() {
  local package=$1 tree=$work/tree release
  mkdir -p "$tree" "$work/kernel/modules"
  dpkg-deb --fsys-tarfile "$package" | tar -x -C "$tree" --wildcards './boot/vmlinuz-*' './lib/modules/*/modules.*' \
    './lib/modules/*/kernel/drivers/virtio/*' './lib/modules/*/kernel/drivers/net/can/*' \
    './lib/modules/*/kernel/drivers/media/*' './lib/modules/*/kernel/fs/*' './lib/modules/*/kernel/net/9p/*' \
    './lib/modules/*/kernel/net/can/*' ||
    fail "$package is not a package of Debian's kernel linux-image-amd64"
  release=$(basename "$tree"/lib/modules/*)
  depmod -b "$tree" "$release"
  copy_modules "$tree" "$release" "$work/kernel/modules/order" "${modules[@]}"
  copy_modules "$tree" "$release" "$work/kernel/modules/camera-order" "${camera_modules[@]}"
  # One camera that takes pictures of a test pattern, as a webcam does: no tuner, no other devices.
  sed -i 's/^vivid.ko$/& n_devs=1 node_types=1 num_inputs=1 input_types=0/' "$work/kernel/modules/camera-order"
  extract_vmlinux "$tree/boot/vmlinuz-$release" >"$work/kernel/vmlinux"
  [ "$(head -c 4 "$work/kernel/vmlinux")" = $'\x7fELF' ] || fail "the kernel of $package is not packed with xz"
}

if [ -n "${KENAF_VCAN_KERNEL_DEB:-}" ]; then
  [ -r "$KENAF_VCAN_KERNEL_DEB" ] || fail "KENAF_VCAN_KERNEL_DEB=$KENAF_VCAN_KERNEL_DEB: no such file"
  package=$KENAF_VCAN_KERNEL_DEB
  kernel=$cache/$(basename "$package" .deb)
else
  package=''
  kernel=$(find "$cache" -maxdepth 1 -name 'linux-image-*' | sort -V | tail -n 1)
fi
# A folder of an older version of this script lacks the camera.
if [ -z "$kernel" ] || [ ! -e "$kernel/vmlinux" ] || [ ! -e "$kernel/modules/camera-order" ]; then
  [ -n "$package" ] || { echo "with-vcan: downloading Debian's kernel into $cache, once" >&2; package=$(download) || exit 1; }
  kernel=$cache/$(basename "$package" .deb)
  unpack "$package"
  rm -rf "$kernel"
  mv -T "$work/kernel" "$kernel"
fi

# The initramfs is made anew when what is in it changed.
busybox=$(command -v busybox)
contents=$(cat "$here/init" "$busybox" "$0" | sha256sum)
if [ "$(cat "$kernel/contents" 2>/dev/null)" != "$contents" ]; then
  mkdir "$work/initramfs"
  cp -r "$kernel/modules" "$work/initramfs/modules"
  cp "$busybox" "$work/initramfs/busybox"
  cp "$here/init" "$work/initramfs/init"
  printf '%s\n' '#!/busybox sh' '/busybox echo kvm works' '/busybox reboot -f' >"$work/initramfs/probe"
  chmod +x "$work/initramfs/init" "$work/initramfs/probe"
  (cd "$work/initramfs" && find . | cpio --quiet -o -H newc -R 0:0) >"$work/initramfs.cpio"
  mv "$work/initramfs.cpio" "$kernel/initramfs.cpio"
  echo "$contents" >"$kernel/contents"
fi
echo "$kernel"

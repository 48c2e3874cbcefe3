#!/usr/bin/env bash
# The libraries need nothing but what every release of Debian has by the same name, and export nothing but hrt.h, in its
# version node.
#
#   needs_test.sh LIBKENAF_SIM LIBKENAF_REAL INCLUDE_DIR
set -euo pipefail
sim=$1 real=$2 include=$3
fail() { printf 'needs_test: %s\n' "$*" >&2; exit 1; }
abi=$(sed -n 's/^#define HRT_ABI //p' "$include/kenaf/hrt.h")

for library in "$sim" "$real"; do
  needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort)
  [ -n "$needed" ] || fail "readelf tells nothing that $library needs"
  # libm is a part of glibc, and so is the loader, which some architectures name
  others=$(grep -vE '^(libc\.so\.6|libm\.so\.6|libstdc\+\+\.so\.6|libgcc_s\.so\.1|libturbojpeg\.so\.0|ld-linux.*)$' <<<"$needed" || true)
  [ -z "$others" ] || fail "$library also needs" $others
  echo "needs_test: $(basename "$library"): " $needed

  # A static libstdc++ would be a second one in every C++ program.
  exported=$(nm -D --defined-only "$library" | awk '{print $3}')
  grep -q hrt_close <<<"$exported" || fail "$library does not export hrt_close"
  others=$(grep -vxE "hrt_[a-z0-9_]+@@KENAF_$abi|KENAF_$abi" <<<"$exported" || true)
  [ -z "$others" ] || fail "$library also exports" $others
done

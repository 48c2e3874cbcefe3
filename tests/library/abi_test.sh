#!/usr/bin/env bash
# The two libraries hold the same binary interface, and the header guards it.
#
#   abi_test.sh LIBKENAF_SIM LIBKENAF_REAL SQUARE_OBJECT SOURCE_DIR CC [LINK_FLAG...]
#
# Exit status 0: everything holds. A tool that is missing is a failure: this test never skips.
set -euo pipefail
sim=$1 real=$2 object=$3 source=$4 cc=$5
link_flags=("${@:6}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'abi_test: %s\n' "$*" >&2; exit 1; }

for tool in abidiff nm readelf "$cc"; do
  command -v "$tool" >/dev/null || fail "$tool is not installed (abidiff: package abigail-tools)"
done

# 1. abidiff: the same functions with the same types. The sonames are meant to differ, so they are not compared; that
#    it sees types at all shows the debug information, without which it would compare names alone.
readelf -S "$sim" | grep -q '\.debug_info' || fail "$sim has no debug information: abidiff would compare names alone"
status=0
abidiff --headers-dir1 "$source/include" --headers-dir2 "$source/include" "$sim" "$real" >"$work/abidiff" 2>&1 || status=$?
grep -E 'Functions changes summary|Variables changes summary|[0-9]+ (Removed|Changed|Added)' "$work/abidiff" || true
[ $((status & 3)) -eq 0 ] || { cat "$work/abidiff" >&2; fail "abidiff could not compare the libraries"; }
if grep -Eq '([1-9][0-9]*) (Removed|Changed|Added)' "$work/abidiff"; then
  cat "$work/abidiff" >&2
  fail "the libraries' interfaces differ"
fi

# 2. nm: the same dynamic symbols, all of them hrt_, and every function that the header declares.
symbols() { nm -D --defined-only "$1" | awk '$2 != "A" {print $2, $3}' | sed 's/@@KENAF_1$//' | sort; }
symbols "$sim" >"$work/sim"
symbols "$real" >"$work/real"
diff "$work/sim" "$work/real" >&2 || fail "the libraries export different symbols"
grep -v '^T hrt_[a-z0-9_]*$' "$work/sim" >&2 && fail "these symbols should not be exported"
printf '#include <kenaf/hrt.h>\n' | "$cc" -x c -std=c11 -I"$source/include" -E -P - |
  tr '\n' ' ' | grep -oE '(int|double|char ?\*) hrt_[a-z0-9_]+\(' | sed -E 's/.*[ *](hrt_[a-z0-9_]+)\(/T \1/' | sort -u >"$work/declared"
[ "$(wc -l <"$work/declared")" -ge 20 ] || fail "found only $(wc -l <"$work/declared") functions in the header"
diff "$work/declared" "$work/sim" >&2 || fail "the header and the libraries do not have the same functions"

# 3. The soname has the number of the interface, and each library has its own.
for library in sim real; do
  [ "$library" = sim ] && file=$sim || file=$real
  readelf -d "$file" | grep -q "SONAME.*\[libkenaf_$library\.so\.1\]" || fail "$file: the soname is not libkenaf_$library.so.1"
done

# 4. One object file links with either library, and the programs load.
for library in "$sim" "$real"; do
  name=$(basename "$library" .so)
  "$cc" "${link_flags[@]}" -o "$work/$name" "$object" "$library" -Wl,-rpath,"$(dirname "$library")" ||
    fail "the square example's object file does not link with $library"
  # Nobody to connect to, and no such interface: each says so and ends with 1.
  status=0
  KENAF_RELAY=127.0.0.1:1 KENAF_CONNECT_TIMEOUT_S=0.05 KENAF_CAN_INTERFACE=nocan7 "$work/$name" >"$work/out" 2>&1 || status=$?
  [ "$status" = 1 ] && grep -q 'HRT_E_LINK\|HRT_E_DEVICE' "$work/out" || { cat "$work/out" >&2; fail "$name: ended with $status"; }
done

# 5. A program that was compiled with a header of another interface does not link; with this one it does.
cat >"$work/program.c" <<'END'
#include <kenaf/hrt.h>
int main(void) { return hrt_kenaf_init(); }
END
mkdir -p "$work/other/kenaf"
sed 's/_abi1$/_abi2/' "$source/include/kenaf/hrt.h" >"$work/other/kenaf/hrt.h"
! cmp -s "$source/include/kenaf/hrt.h" "$work/other/kenaf/hrt.h" || fail "the header has no guard to change"
build() { "$cc" "${link_flags[@]}" -I"$1" -o "$work/program" "$work/program.c" "$sim" -Wl,-rpath,"$(dirname "$sim")" >"$work/log" 2>&1; }
build "$source/include" || { cat "$work/log" >&2; fail "a program with the right header does not link"; }
! build "$work/other" || fail "a program with another interface's header links"
grep -q 'undefined reference.*hrt_kenaf_init_abi2' "$work/log" || { cat "$work/log" >&2; fail "it failed for another reason"; }

echo "abi_test: $(wc -l <"$work/sim") functions, the same in both libraries"

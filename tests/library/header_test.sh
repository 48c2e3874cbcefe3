#!/usr/bin/env bash
# hrt.h compiles without a warning as every standard of C from C89 and of C++ from C++98, and so does a program that uses
# its inline functions.
#
#   header_test.sh INCLUDE_DIR CC CXX
set -euo pipefail
include=$1 cc=$2 cxx=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'header_test: %s\n' "$*" >&2; exit 1; }

cat >"$work/program.c" <<'END'
#include <kenaf/hrt.h>
int main(void) {
  hrt_config config = hrt_config_default();
  hrt_state state = hrt_state_init();
  hrt_picture picture = hrt_picture_init();
  return config.size == sizeof config && state.size == sizeof state && picture.size == sizeof picture ? 0 : 1;
}
END
printf '#include <kenaf/hrt.h>\n' >"$work/header.c"

warnings=(-pedantic-errors -Wall -Wextra -Wdeclaration-after-statement -Wstrict-prototypes -Wshadow -Werror)
for standard in c89 gnu89 c99 c11 c17; do
  for file in header program; do
    "$cc" -std=$standard "${warnings[@]}" -I"$include" -fsyntax-only "$work/$file.c" || fail "$file.c as $standard"
  done
done
warnings=(-pedantic-errors -Wall -Wextra -Wshadow -Werror)
for standard in c++98 c++11 c++14 c++17 c++20; do
  for file in header program; do
    "$cxx" -x c++ -std=$standard "${warnings[@]}" -I"$include" -fsyntax-only "$work/$file.c" || fail "$file.c as $standard"
  done
done
echo "header_test: C89 to C17, C++98 to C++20"

#!/usr/bin/env bash
# Both libraries have the same functions, so a program has one of them. One with both ends before its main(), with words
# that name both, in whichever order and way they came.
#
#   one_library_test.sh LIBKENAF_SIM LIBKENAF_REAL SOURCE_DIR CC
#
# EMULATOR: what runs programs for another machine.
set -euo pipefail
sim=$1 real=$2 source=$3 cc=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf 'one_library_test: %s\n' "$*" >&2; exit 1; }
IFS=';' read -ra emulator <<<"${EMULATOR:-}"
folder=$(dirname "$sim")
abi=$(sed -n 's/^#define HRT_ABI //p' "$source/include/kenaf/hrt.h")

cat >"$work/program.c" <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#ifdef LINKED
#include <kenaf/hrt.h>
#endif

/* Opens the libraries that it is given, each after "local" or "global", and says what each calls itself. */
int main(int argc, char** argv) {
  int i;
  puts("main began");
#ifdef LINKED
  puts(hrt_library());
#endif
  fflush(stdout);
  for (i = 1; i + 1 < argc; i += 2) {
    void* library = dlopen(argv[i + 1], RTLD_NOW | (strcmp(argv[i], "global") == 0 ? RTLD_GLOBAL : RTLD_LOCAL));
    const char* (*name)(void);
    if (!library) return puts(dlerror()), 3;
    *(void**)&name = dlsym(library, "hrt_library");
    puts(name());
    fflush(stdout);
  }
  return 0;
}
END
build() {  # PROGRAM FLAGS...
  local program=$1; shift
  "$cc" -I"$source/include" -o "$work/$program" "$work/program.c" -Wl,--no-as-needed "$@" -Wl,-rpath,"$folder" -ldl
}
build free
build with_sim -DLINKED "$sim"
build with_real -DLINKED "$real"
build sim_first -DLINKED "$sim" "$real"
build real_first -DLINKED "$real" "$sim"

# EXPECTED OUTPUT: the program starts, and says so.
starts() {
  local expected=$1 output; shift
  output=$("${emulator[@]}" "$@" 2>&1) || fail "$* ended with status $?: $output"
  [ "$(tr '\n' ' ' <<<"$output")" = "$expected " ] || fail "$* said '$output', not '$expected'"
}
# WORDS_BEFORE: what it may have said before it ends.
refuses() {
  local before=$1 output errors status=0; shift
  output=$("${emulator[@]}" "$@" 2>"$work/errors") || status=$?
  errors=$(cat "$work/errors")
  [ "$status" = 127 ] || fail "$* ended with status $status: $output $errors"
  [ "$(tr '\n' ' ' <<<"$output")" = "$before " ] || fail "$* said '$output' before it ended"
  for words in libkenaf_sim.so libkenaf_real.so "same functions" "link the program with one of them"; do
    grep -qF "$words" <<<"$errors" || fail "$* did not say '$words': $errors"
  done
}
sim_file=$folder/libkenaf_sim.so.$abi real_file=$(dirname "$real")/libkenaf_real.so.$abi

# One of them, or each in a place of its own, as Python's modules have them.
starts "main began sim" "$work/with_sim"
starts "main began real" "$work/with_real"
starts "main began sim real" "$work/free" local "$sim_file" local "$real_file"
starts "main began real sim" "$work/free" local "$real_file" local "$sim_file"
starts "main began sim sim" "$work/with_sim" local "$sim_file"

# Both, as the linker, the loader or the program brings them.
refuses "" "$work/sim_first"
refuses "" "$work/real_first"
refuses "" env LD_PRELOAD="$real_file" "$work/with_sim"
refuses "main began sim" "$work/with_sim" local "$real_file"
refuses "main began real" "$work/with_real" global "$sim_file"
refuses "main began sim" "$work/free" global "$sim_file" local "$real_file"

# Their pkg-config files say so. pkgconf 1.8, of Debian 12 and 13, only looks at what a package itself requires.
# alone_test.sh has CMake's refusal.
for library in sim real; do
  [ $library = sim ] && other=real || other=sim
  grep -qx "Conflicts: kenaf-$other" "$source/cmake/kenaf-$library.pc.in" || fail "kenaf-$library.pc does not say 'Conflicts'"
done
echo "one_library_test: one of them starts, both do not"

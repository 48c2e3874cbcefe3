#!/usr/bin/env bash
# The installed programs run without the source tree.
#
#   programs.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
for program in kenaf-candrives kenaf-canlog kenaf-describe kenaf-draw kenaf-relayd kenaf-world; do
  [ -x "$installed/bin/$program" ] || fail "$program is not installed"
done

version=$("$installed/bin/kenaf-world" --version) || fail "kenaf-world does not tell its version"
libraries=$(dirname "$(find "$installed" -name 'libkenaf_sim.so')")
for program in $(programs); do
  LD_LIBRARY_PATH=$libraries "$installed/bin/$program" --help >"$work/help" || fail "$program has no help"
  grep -q '^Usage: ' "$work/help" || fail "the help of $program does not say how it is used"
  [[ $program != kenaf-* ]] || [ "$("$installed/bin/$program" --version)" = "$version" ] ||
    fail "$program is not of version $version"
done

# The world server finds its robots and worlds.
cd "$work"
start world.log 'world .* on ' "$installed/bin/kenaf-world" --port 0 --view off --cameras off
stop

# Hardened, as Debian's own programs: position independent, relocations read-only from the start, stack protected,
# libc's functions checked.
says() { readelf --wide "$1" "$2" >"$work/elf" && grep -qE "$3" "$work/elf"; }
for file in "$installed"/bin/* "$libraries"/libkenaf_*.so.*.*; do
  says --file-header "$file" 'DYN ' || fail "$file is not position independent"
  says --program-headers "$file" GNU_RELRO || fail "$file has no read-only relocations"
  says --dynamic "$file" 'BIND_NOW|FLAGS.* NOW' || fail "$file binds lazily"
  says --dyn-syms "$file" __stack_chk_fail || fail "$file has no stack protector"
  says --dyn-syms "$file" '__[a-z_]+_chk@' || fail "$file does not check libc's calls"
done

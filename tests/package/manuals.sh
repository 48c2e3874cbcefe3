#!/usr/bin/env bash
# Each installed program has a manual page with all its parts; the library and its configuration have theirs; troff has
# nothing to complain about; and what the examples show is what the programs take.
#
#   manuals.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
manuals=$installed/share/man
[ -d "$manuals/man1" ] || skip "this build has no manual pages: there was no help2man"
command -v groff >/dev/null || skip "there is no groff; scripts/install-dependencies.sh installs it"
libraries=$(dirname "$(find "$installed" -name 'libkenaf_sim.so')")

has_sections() {  # PAGE SECTION...
  local page=$1 section; shift
  for section in "$@"; do
    grep -qxE "\.SH \"?$section\"?" "$page" || fail "$page has no section $section"
  done
}
for program in $(programs); do
  page=$manuals/man1/$program.1
  [ -f "$page" ] || fail "$program has no manual page"
  has_sections "$page" NAME SYNOPSIS DESCRIPTION OPTIONS "EXIT STATUS" EXAMPLES "SEE ALSO" ENVIRONMENT FILES

  # The options of a page's examples are those of the program they call.
  groff -man -Tascii -P-c "$page" 2>/dev/null | sed -n '/^EXAMPLES/,/^SEE ALSO/p' | tr -s ' \n' ' ' >"$work/examples"
  LD_LIBRARY_PATH=$libraries "$source/cmake/whole-help.sh" "$installed/bin/$program" >"$work/help"
  for option in $(grep -oE "(^| )--[a-z-]+" "$work/examples" | sort -u); do
    grep -qE -- "$option([ =,]|\$)" "$work/help" || grep -q "systemctl.* $option" "$work/examples" ||
      fail "the examples of $program use $option, which its help does not know"
  done
done
has_sections "$manuals/man3/hrt.3" NAME SYNOPSIS DESCRIPTION ENVIRONMENT EXAMPLES "SEE ALSO"
has_sections "$manuals/man5/kenaf.toml.5" NAME DESCRIPTION KEYS ENVIRONMENT FILES EXAMPLES "SEE ALSO"

# Every function of the header is in the library's page, and leads to it; every key of a configuration is in its page.
for function in $(grep -oE '\bhrt_[a-z_]+\(' "$source/include/kenaf/hrt.h" | tr -d '(' | sort -u); do
  [ "$(readlink "$manuals/man3/$function.3")" = hrt.3 ] || [ "$function" = hrt_flipper ] || fail "$function has no manual page"
  grep -q "^\.B .*$function(" "$manuals/man3/hrt.3" || fail "hrt(3) does not explain $function"
done
sed -n '/^typedef struct hrt_config {/,/^} hrt_config;/p' "$source/include/kenaf/hrt.h" |
  grep -oE '^  (double|int32_t|char) [a-z0-9_]+' | awk '{ print $2 }' |
  while read -r key; do
    grep -q "^\.BR $key " "$manuals/man5/kenaf.toml.5" || fail "kenaf.toml(5) does not have the key $key"
  done

for page in $(find "$manuals" -name '*.[135]' -type f); do
  said=$(groff -ww -man -Tutf8 -z "$page" 2>&1)
  [ -z "$said" ] || fail "$page: $said"
done

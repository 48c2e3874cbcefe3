#!/usr/bin/env bash
# Installs into a folder below the build, and makes the packages there, for the other tests of this folder. What is
# installed lies below the prefix and holds no path of the source tree.
#
#   install.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"

rm -rf "$installed" "$debs"
mkdir -p "$debs"
cmake --install "$build" --prefix "$installed" >"$work/install.log"
outside=$(grep -E '^-- (Installing|Up-to-date): ' "$work/install.log" | grep -vF ": $installed/" || true)
[ -z "$outside" ] || fail "installed outside of the prefix: $outside"

# What is installed holds no path of the source tree, so it cannot need one. (The build tree may lie in it.)
holding=$(LC_ALL=C grep -rlaP "(?<![\w./-])\Q$source\E(?![\w.-])" "$installed" || true)
[ -z "$holding" ] || fail "the source folder's path is in $holding"

# A link leads to what is installed too: the machine that built it is not the one that uses it.
dangling=$(find "$installed" -type l ! -exec test -e {} \; -print)
[ -z "$dangling" ] || fail "these links lead nowhere: $dangling"
away=$(find "$installed" -type l -lname '/*' -print)
[ -z "$away" ] || fail "these links lead out of the prefix: $away"

(cd "$debs" && cpack --config "$build/CPackConfig.cmake" -B "$debs" >"$work/cpack.log" 2>&1) ||
  { cat "$work/cpack.log"; fail "cpack"; }
rm -rf "$debs/_CPack_Packages"

#!/usr/bin/env bash
# lintian(1), Debian's check of packages, finds neither errors nor warnings, but for those that a package explains
# (cmake/debian/PACKAGE.lintian-overrides).
#
#   lintian.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
command -v lintian >/dev/null || skip "there is no lintian; scripts/install-dependencies.sh installs it"

lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$debs"/*.deb || fail "lintian found what is above"

# An explanation of something that is no longer so is not kept, and none is without a reason: a comment before it.
for overrides in "$source"/cmake/debian/*.lintian-overrides; do
  awk -v file="$overrides" '
    /^#/ { explained = 1; next }
    /^$/ { explained = 0; next }
    !explained { print file ":" NR ": says no reason"; bad = 1 }
    END { exit bad }' "$overrides" || fail "explain it in a comment before it"
done
unused=$(lintian --allow-root --display-info "$debs"/*.deb | grep unused-override || true)
[ -z "$unused" ] || fail "$unused"

# shellcheck shell=bash disable=SC2034
# What the tests of the installation share; sourced with BUILD_DIR SOURCE_DIR. install.sh, which ctest runs before, has
# filled $installed with what `cmake --install` installs, and $debs with the packages.
set -euo pipefail
build=$1 source=$2
installed=$build/package-test/prefix
debs=$build/package-test/debs
test_name=$(basename "$0" .sh)
work=$(mktemp -d)
server=
clean_up() {
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT
fail() { echo "$test_name: $*" >&2; exit 1; }
skip() { echo "$test_name: skipped: $*"; exit 77; }
# A user's shell has neither.
unset KENAF_DATA_DIR PYTHONPATH

# The installed programs of the project.
programs() { (cd "$installed/bin" && ls); }

# start LOG PATTERN COMMAND...: starts a server in the background, as $server, and waits until its log has the pattern; prints
# what of the log matches. A loaded machine may take long; a server that ends is noticed at once.
start() {
  local log=$1 pattern=$2; shift 2
  : >"$log"
  "$@" >"$log" 2>&1 & server=$!
  until grep -qE "$pattern" "$log"; do
    kill -0 "$server" 2>/dev/null || { cat "$log" >&2; fail "$1 ended before it said '$pattern'"; }
    sleep 0.1
  done
}
# stop: ends it; it must end with 0.
stop() {
  local status=0
  kill -TERM "$server"
  wait "$server" || status=$?
  server=
  [ "$status" = 0 ] || fail "the server ended with status $status"
}

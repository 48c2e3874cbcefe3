#!/bin/sh
# The help of a program with commands: its own, and each command's below a heading, as help2man reads headings.
#
#   whole-help.sh PROGRAM
set -eu
program=$1
"$program" --help
"$program" --help | sed -n '/^Subcommands:/,$ s/^  \([a-z-]\{1,\}\) .*/\1/p' | while read -r command; do
  "$program" "$command" --help | awk '
    NR == 1 { what = $0; next }
    sub(/^Usage: /, "") { printf "\n%s:\n  %s\n\n", $0, what; next }
    /^(Positionals|Options):$/ || /^  -h,--help / || /^$/ { next }
    { print }'
done

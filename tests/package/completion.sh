#!/usr/bin/env bash
# Completion offers every option and command that the programs' help lists, and the values of which there is a list.
#
#   completion.sh BUILD_DIR SOURCE_DIR
. "$(dirname "$0")/common.sh"
completions=$installed/share/bash-completion/completions
[ -d "$completions" ] || skip "this build has no completion: there was no python3"
libraries=$(dirname "$(find "$installed" -name 'libkenaf_sim.so')")
cd "$work"
touch run.csv

# offers PROGRAM WORD...: what bash offers in place of the last word, a line each.
offers() (
  # shellcheck source=/dev/null
  . "$completions/$1"
  compopt() { :; }  # only readline has it
  export PATH=$installed/bin:$PATH
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  "_${1//-/_}"
  printf '%s\n' "${COMPREPLY[@]}"
)
expect() {  # EXPECTED PROGRAM WORD...: the expected word is among the offered
  local expected=$1; shift
  offers "$@" >offered || true  # no word fits: compgen fails
  grep -qxF -- "$expected" offered || fail "'$*' is not completed by '$expected', but by: $(tr '\n' ' ' <offered)"
}

options_of() { grep -oE '^  -[-a-zA-Z,]+' | tr -d ' ' | tr ',' '\n'; }
for program in $(programs); do
  help() { LD_LIBRARY_PATH=$libraries "$installed/bin/$program" "$@" --help; }
  for option in $(help | options_of); do expect "$option" "$program" "$option"; done
  for command in $(help | sed -n '/^Subcommands:/,$ s/^  \([a-z-]\{1,\}\) .*/\1/p'); do
    expect "$command" "$program" ""
    for option in $(help "$command" | options_of); do expect "$option" "$program" "$command" "$option"; done
  done
done
expect stairs kenaf-world --world st
expect udk kenaf-world --dialect ""
expect udk kenaf-world --dialect = u  # as readline parts --dialect=u
expect husky kenaf-relayd --embedded --robot h
[ -z "$(offers kenaf-world --port "")" ] || fail "a port is completed"
if [ -x "$installed/bin/kenaf-gap" ]; then
  expect turn-in-place kenaf-gap simulate --manoeuvre turn
  expect run.csv kenaf-gap play run
fi

# zsh: the functions that complete are called with what they would offer.
command -v zsh >/dev/null || { echo "completion: zsh's was not tried: there is no zsh"; exit 0; }
functions=$installed/share/zsh/site-functions
for program in $(programs); do
  zsh -f -n "$functions/_$program" || fail "_$program is no zsh"
  LD_LIBRARY_PATH=$libraries "$installed/bin/$program" --help | options_of >options
  zsh -f -c '
    _arguments() { print -rl -- "$@"; [[ -z $state_wanted ]] || state=$state_wanted }
    _describe() { print -rl -- "${(@P)2}" }
    _files() { print files }
    state_wanted=command; words=('"$program"' ""); CURRENT=2
    source '"$functions/_$program" >said || fail "_$program failed"
  while read -r option; do
    grep -qE -- "\)$option=?\[" said || grep -qE -- "\*$option=?\[" said || fail "_$program does not complete $option"
  done <options
done

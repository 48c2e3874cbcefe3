# To be sourced: waiting that starts no process. Each process costs an emulated machine a tenth of a second; grep and sleep,
# over and over, cost more than what is waited for.

exec {never_written}<> <(:)

pause() { read -rt "$1" -u "$never_written"; true; }  # SECONDS

# holds FILE WORDS: a file that is not there yet holds nothing.
holds() {
  local text=''
  { IFS= read -rd '' text <"$1"; } 2>/dev/null
  [[ $text == *"$2"* ]]
}

# wait_until SECONDS COMMAND [ARGUMENT...]: until the command (a function, or built in) succeeds.
wait_until() {
  local i seconds=$1; shift
  for ((i = 0; i < 20 * seconds; ++i)); do "$@" && return; pause 0.05; done
  false
}

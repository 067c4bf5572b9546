# Shared code of the command tests. Each is called with: the command, the source folder, the build folder.
# BRECCIA_WHOLE=1 asks for whole walks and all decks instead of samples (.ci/nightly).
set -u
breccia=$1 source=$2 build=$3
work=$(mktemp -d "${TMPDIR:-/tmp}/breccia test.XXXXXX") # a path with a space in it
trap 'rm -rf "$work"' EXIT
failures=0 checks=0

fail() {
  echo "FAIL: $*"
  failures=$((failures + 1))
}

# contains WHAT TEXT WORDS: TEXT must hold WORDS
contains() {
  checks=$((checks + 1))
  case $2 in *"$3"*) ;; *) fail "$1: expected «$3», found: $2" ;; esac
}

# equal WHAT FOUND EXPECTED
equal() {
  checks=$((checks + 1))
  [ "$2" = "$3" ] || fail "$1: expected «$3», found «$2»"
}

# wait_for PROCESS CONDITION: until the condition holds, or the process has ended; however slow the machine is
wait_for() {
  local process=$1
  shift
  until "$@"; do
    kill -0 "$process" 2> /dev/null || { "$@"; return; }
    sleep 0.05
  done
}

# Words of a JSON file's "key": value
json() {
  sed -n "s/.*\"$2\": \([^,}]*\).*/\1/p" "$1" | head -1
}

# left_out N: true of all but every Nth call, under the sanitizers: what is alike walks the same code of ours each time, and there a start of the program takes long
turn=0
left_out() {
  [ -n "${BRECCIA_SANITIZED:-}" ] && [ $((turn++ % $1)) != 0 ]
}
finish() {
  echo "$checks checks, $failures failed"
  [ $failures = 0 ]
}

#!/bin/sh
# docs/command.md: what the command says of itself. Called with the command.
set -eu
echo '# The command'
echo
echo 'What `breccia --help` and `breccia VERB --help` print; made by `make docs`.'
echo
echo '```'
"$1" --help | sed '1s/^breccia [^:]*:/breccia:/'
echo '```'
for verb in $("$1" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do
  printf '\n## %s\n\n```\n' "$verb"
  "$1" "$verb" --help
  echo '```'
done

#!/bin/sh
# Small faults in changed lines, from universalmutator in an environment of the project's own. Arguments go to mutants.py.
set -eu
cd "$(dirname "$0")/../.."
environment=.venv/mutants
if ! cmp -s tests/mutants/requirements.txt "$environment/installed" 2> /dev/null; then
  python3 -m venv --clear "$environment"
  "$environment/bin/python" -m pip install --quiet --disable-pip-version-check -r tests/mutants/requirements.txt
  cp tests/mutants/requirements.txt "$environment/installed"
fi
exec "$environment/bin/python" tests/mutants/mutants.py "$@"

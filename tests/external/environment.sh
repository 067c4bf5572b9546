#!/bin/sh
# The environments of the tests that need other people's programs: VTK and readers of its files, and OpenSees. Does nothing when they are there.
set -eu
cd "$(dirname "$0")/../.."
environment=.venv/external
if ! cmp -s tests/external/requirements.txt "$environment/installed" 2> /dev/null; then
  python3 -m venv --clear "$environment"
  "$environment/bin/python" -m pip install --quiet --disable-pip-version-check -r tests/external/requirements.txt
  cp tests/external/requirements.txt "$environment/installed"
fi
sh scripts/opensees.sh

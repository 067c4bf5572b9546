#!/bin/sh
# The environments of the tests that need other people's programs: VTK and readers of its files, the same with the newest VTK that was tried, and
# OpenSees. Does nothing when they are there.
set -eu
cd "$(dirname "$0")/../.."

# make_environment FOLDER REQUIREMENTS
make_environment() {
  cmp -s "$2" "$1/installed" 2> /dev/null && return
  python3 -m venv --clear "$1"
  "$1/bin/python" -m pip install --quiet --disable-pip-version-check -r "$2"
  cp "$2" "$1/installed"
}

make_environment .venv/external tests/external/requirements.txt
make_environment .venv/external-newest tests/external/requirements-newest.txt
sh scripts/opensees.sh

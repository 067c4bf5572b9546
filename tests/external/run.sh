#!/bin/sh
# Tests that need other people's programs: an environment of the project's own, then each test.
set -eu
cd "$(dirname "$0")/../.."
sh tests/external/environment.sh
cmake --preset test > /dev/null
cmake --build --preset test --target breccia_command compare_results > /dev/null
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" # the command as it is tested, with OpenSees beside it
cp build/test/breccia build/test/tests/compare_results build/release/breccia-opensees build/release/breccia-opensees-tcl "$work/bin"
passed=0 failed=0
for test in tests/external/test_*.py; do
  environments=.venv/external
  case $test in *_reads_results.py) environments="$environments .venv/external-newest" ;; esac # readers of files, old and new
  for environment in $environments; do
    mkdir "$work/here"
    if "$environment/bin/python" "$test" "$work/bin/breccia" "$work/here"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
    rm -r "$work/here"
  done
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]

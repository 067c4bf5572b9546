#!/bin/sh
# Builds and runs tests, and prints the ten that took longest.
#   tests.sh PRESET [LABEL ...]   PRESET: one of CMakePresets.json; LABEL: a matter or the name of a test (tests/CMakeLists.txt)
# Without a label it runs the tests that do not have the label `long`, with ALL=1 all.
set -eu
preset=$1
shift
folder=build/$preset cores=$(nproc 2> /dev/null || echo 2)
mkdir -p "$folder"
cmake --preset "$preset" > "$folder/configure.txt" 2>&1 || { cat "$folder/configure.txt"; exit 1; }
targets="" labels=""
for label in "$@"; do
  targets="$targets tests_of_$label" labels="$labels${labels:+|}$label"
done
cmake --build --preset "$preset" --parallel "$cores" ${targets:+--target $targets}
status=0 quick=""
[ -n "$labels" ] || [ -n "${ALL:-}" ] || quick="-LE ^long$"
# One test more than there are cores: some wait for sockets and servers.
ctest --preset "$preset" --parallel $((cores + 1)) --no-tests=error --output-junit tests.xml ${labels:+-L "^($labels)\$"} $quick || status=$?
echo "ten slowest tests, in seconds beside others:"
sed -n 's/.*<testcase name="\([^"]*\)".* time="\([0-9.]*\)".*/\2 \1/p' "$folder/tests.xml" | sort -rn | head -10 |
  while read -r seconds name; do printf '  %6.1f  %s\n' "$seconds" "$name"; done
[ -z "$quick" ] || echo "tests that take long were left out: ALL=1 runs them, too"
exit $status

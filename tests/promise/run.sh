#!/usr/bin/env bash
# The promise of docs/design.md 3: a law, a formulation, a criterion, a lattice, a reader of files, a force, a load, a constraint, a history, a solver
# and an output field are each one new file (a lattice: none) and one line in a list. In a copy of the sources one of each is added so; the program
# is built, and runs a deck with all of them.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/breccia-promise.XXXXXX")
trap 'rm -rf "$work"' EXIT
fail() { echo "promise: $*" >&2; exit 1; }

mkdir "$work/tree"
cp -r "$source/CMakeLists.txt" "$source/source" "$source/include" "$source/scripts" "$source/examples" "$source/bench" "$source/servers" "$work/tree"
cd "$work/tree"
grep -rqi promised source && fail "the sources hold a dummy already"
cp -r "$here/source/." source
lines=0
while read -r list line; do
  case $list in '' | '#'*) continue ;; esac
  [ -f "$list" ] || fail "$list is not there"
  awk -v line="$line" '/^#undef/ && !done && NR > 1 {print line; done = 1} {print} END {if (!done) print line}' "$list" > list.new
  mv list.new "$list"
  lines=$((lines + 1))
done < "$here/lines"
files=$(find "$here/source" -name '*.c' | wc -l)
[ "$lines" = $((files + 1)) ] || fail "$files files but $lines lines; each kind has one of both, a lattice a line only"

launcher=$(command -v ccache || true)
cmake -G Ninja -S . -B build -DCMAKE_BUILD_TYPE=Debug -DBRECCIA_LANE_KINDS=OFF ${launcher:+-DCMAKE_C_COMPILER_LAUNCHER=ccache} > log 2>&1 &&
  CCACHE_NOHASHDIR=1 CCACHE_BASEDIR="$work" cmake --build build --target breccia_command > log 2>&1 || fail "it does not build: $(grep -m3 error log || tail -3 log)"

cp "$here/deck.yaml" .
awk 'BEGIN {for (i = 0; i < 4; ++i) for (j = 0; j < 6; ++j) for (k = 0; k < 6; ++k)
  print 0.105 + 0.01 * i, 0.005 + 0.01 * j, 0.005 + 0.01 * k, 1e-6}' > particles.promised
build/breccia run deck.yaml --quiet > out 2>&1 || fail "the deck does not run: $(cat out)"
grep -q '"completed": true' deck/summary.json || fail "the run did not end well"
grep -q '"name": "coast"' deck/summary.json || fail "the solver was not used"
grep -q '"first_broken_bond": {' deck/summary.json || fail "the criterion broke no bond"
build/breccia plot deck --field "promised field" --output field.png > out 2>&1 || fail "the field cannot be drawn: $(cat out)"
build/breccia models promised > /dev/null || fail "the law is not listed"
build/breccia schema --markdown > page
for word in "promised elongation" "promised share" "promised push" "promised hold" "promised lattice" "promised field" "promised stiffness" "comes near 1"; do
  grep -q "$word" page || fail "the deck reference does not know '$word'"
done
echo "promise: $files files and $lines lines, built and run"

# Every call by which a run writes into its folder fails in turn, once or for good, as a full or broken disk lets it fail. Whatever call it is:
# one line says which file could not be written and why, the status is 1, nothing half written stays, and the run can be taken up, or begun
# again, and ends in the same bits. IO_FAULTS=K takes every Kth call, in all ways (make torture: 1); else some are taken.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
if [ -n "${BRECCIA_SANITIZED:-}" ]; then
  echo "not under sanitizers, which want to be loaded first"
  exit 0
fi
cat > bar.yaml <<'Y'
title: Bar
materials: {m: {model: elastic, Young modulus: 1 GPa, Poisson ratio: 0.2, density: 2000}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [12, 5]}}}}
peridynamics: {space: plane strain}
failure: {critical stretch: 0.002, near grips: break}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {face: x+, layers: 3}, velocity: [5, free]}
solve: {explicit: {time step: 2e-5, steps: 60}}
watch: {end: {displacement of: {face: x+}, every: 5}, energy: {energy: yes, every: 20}}
results: {number: 4, checkpoint steps: 25, precision: double, fields: [displacement, damage]}
pictures: []
Y
# The same bar at rest: it is pulled in increments, bonds break between them, and it is unloaded.
{
  grep -E '^(title|materials|body|peridynamics|failure):' bar.yaml
  cat << 'Y'
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, 0]}
  - {on: {face: x+, layers: 3}, displacement: [1.3e-3, free], history: {table: [[0, 0], [0.6, 1], [1, 0.4]]}}
solve: {static: {increments: 10}}
watch: {end: {displacement of: {face: x+}}, energy: {energy: yes, every: 3}}
results: {number: 4, checkpoint steps: 3, precision: double, fields: [displacement, damage]}
pictures: []
Y
} > rest.yaml
deck=bar whole=whole within= # a file of the folder, or all of them
run() { # run FOLDER [options]
  "$breccia" run $deck.yaml --quiet --threads 1 --output "$@" > out 2>&1
}
run whole || fail "the whole run failed: $(cat out)"
[ "$(json whole/summary.json broken_bonds)" -gt 0 ] || fail "no bond breaks, the test is too tame"

same() { # same FOLDER WHAT: all that a run leaves is as in the whole run
  checks=$((checks + 1))
  cmp -s $whole/end.csv "$1/end.csv" && cmp -s $whole/energy.csv "$1/energy.csv" || fail "$2: histories differ"
  "$build/tests/compare_results" $whole/results.vtkhdf "$1/results.vtkhdf" > out || fail "$2: results differ: $(cat out)"
  "$build/tests/compare_results" $whole/checkpoint.h5 "$1/checkpoint.h5" > out || fail "$2: checkpoints differ: $(cat out)"
  cmp -s $whole/results.xdmf "$1/results.xdmf" || fail "$2: results.xdmf differs"
  [ ! -e $whole/solution.txt ] || cmp -s $whole/solution.txt "$1/solution.txt" || fail "$2: solution.txt differs"
}

# fault NUMBER ERROR WORDS LASTS: one run that meets it, and what follows
fault() {
  local what="call $1, $3$([ "$4" = 1 ] && echo ", for good")" status
  rm -rf faulty count
  FAULT_FOLDER="$work/faulty$within" FAULT_COUNT="$work/count" FAULT_AT=$1 FAULT_ERROR=$2 FAULT_LASTS=$4 LD_PRELOAD="$build/tests/libio_faults.so" \
    "$breccia" run $deck.yaml --threads 1 --output faulty > told 2> out
  status=$?
  if [ "$(wc -c < count)" -lt "$1" ]; then # on a fast disk states are copied more often than on a slow one
    equal "$what, which was not reached" $status 0
    same faulty "$what, which was not reached"
    return
  fi
  checks=$((checks + 5))
  [ $status = 1 ] || fail "$what: status $status: $(cat out)"
  [ "$(wc -l < out)" = 1 ] || fail "$what: expected one line, found: $(cat out)"
  grep -q "^faulty/[a-z.]*[a-z0-9]: cannot be written: $3" out || fail "$what: the line does not say which file and why: $(cat out)"
  [ -z "$(find faulty -name '*.part')" ] || fail "$what: left behind: $(find faulty -name '*.part')"
  if [ -e faulty/results.vtkhdf.journal ]; then # large results: the last state is in there, and whoever looks at them puts it in
    journals=$((journals + 1))
    rm -rf looked
    cp -r faulty looked
    "$breccia" plot looked --field damage > out 2>&1 || fail "$what: cannot be looked at: $(cat out)"
    [ ! -e looked/results.vtkhdf.journal ] || fail "$what: the journal stays"
  fi
  local again= how='begin it again'
  [ -e faulty/checkpoint.h5 ] && again=--restart how='--restart goes on from the last checkpoint'
  if grep -q '^stopped' told && ! grep -q "^once files can be written again, $how" told; then
    fail "$what: how to go on is not told: $(cat told)"
  fi
  run faulty $again || fail "$what: cannot be taken up: $(cat out)"
  same faulty "$what"
}

export FAULT_EXCEPT=run.lock
# What lies in the folder cannot be read: a restart, and a look at results. One line tells it, and nothing is harmed.
run half --steps 30 || fail "the first half failed: $(cat out)"
reading() { # reading NUMBER COMMAND...: one command whose NUMBERth call that reads in 'faulty' fails
  rm -rf faulty count
  cp -r half faulty
  FAULT_FOLDER="$work/faulty" FAULT_COUNT="$work/count" FAULT_READS=1 FAULT_AT=$1 FAULT_ERROR=5 LD_PRELOAD="$build/tests/libio_faults.so" \
    "$breccia" "${@:2}" > told 2> out
}
restart="run bar.yaml --quiet --threads 1 --output faulty --restart" look="plot faulty --field damage" reads=
for command in "$restart" "$look"; do
  reading 0 $command; equal "$command: status" $? 0
  all=$(wc -c < count)
  [ "$all" -gt 20 ] || fail "$command: only $all calls that read were seen"
  for number in $(seq 1 "${IO_FAULTS:-1}" "$all") "$all"; do
    reading "$number" $command
    status=$? checks=$((checks + 3))
    [ $status = 1 ] || fail "$command: read $number: status $status: $(cat out)"
    [ "$(wc -l < out)" = 1 ] && grep -q "^faulty/[a-z.]*[a-z0-9]: .*Input/output error" out || fail "$command: read $number: $(cat out)"
    run faulty --restart || fail "$command: read $number: cannot be taken up: $(cat out)"
    same faulty "$command: read $number"
  done
  reads="$reads, $all reads of ${command%% *}"
done

echo $reads
finish

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
cp "$build/tests/libio_faults.so" . || exit 1 # LD_PRELOAD ends a name at a blank
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
  FAULT_FOLDER="$work/faulty$within" FAULT_COUNT="$work/count" FAULT_AT=$1 FAULT_ERROR=$2 FAULT_LASTS=$4 LD_PRELOAD=./libio_faults.so \
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

export FAULT_EXCEPT=run.lock # nobody needs what is in it
FAULT_FOLDER="$work/counted" FAULT_COUNT="$work/count" LD_PRELOAD=./libio_faults.so run counted
calls=$(wc -c < count)
[ "$calls" -gt 200 ] || fail "only $calls calls were seen: the walk does not see how files are written"
same counted "no fault"
tried=0 lost=0
try() { # as fault
  local before=$failures
  fault "$@"
  tried=$((tried + 1)) lost=$((lost + (failures > before)))
}
if [ -n "${IO_FAULTS:-}" ]; then
  for ((number = 1; number <= calls; number += IO_FAULTS)); do
    for lasts in 0 1; do
      try $number 5 "Input/output error" $lasts
      try $number 28 "No space left on device" $lasts
    done
  done
else
  # In steps of a prime, so that all kinds of calls are among the sample.
  for number in $(seq 1 41 "$calls") $((calls - 4)) $((calls - 3)); do # the last two: histories are closed
    if [ $((number % 2)) = 0 ]; then try $number 5 "Input/output error" $((number / 2 % 2))
    else try $number 28 "No space left on device" $((number / 2 % 2)); fi
  done
fi

# What a checkpoint counts on is brought to the disk before it: results and histories once for each of the three checkpoints.
for file in results.vtkhdf end.csv energy.csv; do
  rm -f count
  FAULT_FOLDER="$work/settled/$file" FAULT_COUNT="$work/count" LD_PRELOAD=./libio_faults.so run settled
  settled=$(tr -dc s < count | wc -c)
  [ "$settled" -ge 3 ] || fail "$file was brought to the disk $settled times, for 3 checkpoints"
  checks=$((checks + 1))
done

# The same where results are large, and are written in place with a journal beside them.
export FAULT_LARGER=300000000
journals=0
rm -f count
FAULT_FOLDER="$work/large" FAULT_COUNT="$work/count" LD_PRELOAD=./libio_faults.so run large
large=$(wc -c < count)
same large "large results"
if [ -n "${IO_FAULTS:-}" ]; then
  for ((number = 1; number <= large; number += IO_FAULTS)); do
    for lasts in 0 1; do try $number 5 "Input/output error" $lasts; done
  done
else
  for number in $(seq 60 17 150); do try $number 5 "Input/output error" $((number % 2)); done # the first two states
fi
[ $journals -gt 0 ] || fail "no journal was left, the test is too tame"
unset FAULT_LARGER

deck=rest whole=still
run still || fail "the run at rest failed: $(cat out)"
[ "$(json still/summary.json broken_bonds)" -gt 0 ] || fail "no bond breaks at rest, the test is too tame"
for within in '' /solution.txt; do # what it tells of its equations is written seldom
  rm -f count
  FAULT_FOLDER="$work/resting$within" FAULT_COUNT="$work/count" LD_PRELOAD=./libio_faults.so run resting
  resting=$(wc -c < count)
  [ "$resting" -gt 10 ] || fail "only $resting calls on resting$within were seen"
  same resting "at rest"
  for number in $(seq 3 "${IO_FAULTS:-$((resting / 4))}" "$resting"); do try $number 28 "No space left on device" $((number % 2)); done
done
deck=bar whole=whole within=

# A folder that cannot be made: by a full disk it is a failure, by its name the user's mistake.
FAULT_FOLDER="$work/deep" FAULT_AT=1 FAULT_ERROR=28 LD_PRELOAD=./libio_faults.so run deep/inner; equal "no folder: status" $? 1
equal "no folder" "$(cat out)" "deep/inner: the folder cannot be made: No space left on device"
run bar.yaml/inner; equal "no folder in a file: status" $? 2

# What lies in the folder cannot be read: a restart, and a look at results. One line tells it, and nothing is harmed.
run half --steps 30 || fail "the first half failed: $(cat out)"
reading() { # reading NUMBER COMMAND...: one command whose NUMBERth call that reads in 'faulty' fails
  rm -rf faulty count
  cp -r half faulty
  FAULT_FOLDER="$work/faulty" FAULT_COUNT="$work/count" FAULT_READS=1 FAULT_AT=$1 FAULT_ERROR=5 LD_PRELOAD=./libio_faults.so \
    "$breccia" "${@:2}" > told 2> out
}
restart="run bar.yaml --quiet --threads 1 --output faulty --restart" look="plot faulty --field damage" reads=
for command in "$restart" "$look"; do
  reading 0 $command; equal "$command: status" $? 0
  all=$(wc -c < count)
  [ "$all" -gt 20 ] || fail "$command: only $all calls that read were seen"
  for number in $(seq 1 "${IO_FAULTS:-17}" "$all") "$all"; do
    reading "$number" $command
    status=$? checks=$((checks + 3))
    [ $status = 1 ] || fail "$command: read $number: status $status: $(cat out)"
    [ "$(wc -l < out)" = 1 ] && grep -q "^faulty/[a-z.]*[a-z0-9]: .*Input/output error" out || fail "$command: read $number: $(cat out)"
    run faulty --restart || fail "$command: read $number: cannot be taken up: $(cat out)"
    same faulty "$command: read $number"
  done
  reads="$reads, $all reads of ${command%% *}"
done

# Signals interrupt calls, and a call may do less than it was asked for: nothing of it is seen.
trickle() { # trickle FOLDER COMMAND...: one command that reads and writes in the folder by halves
  FAULT_FOLDER="$work/$1" FAULT_TRICKLES=1 LD_PRELOAD=./libio_faults.so "$breccia" "${@:2}" > out 2>&1
  equal "by halves: ${*:2}: status: $(cat out)" $? 0
}
rm -rf faulty looked
trickle slow run bar.yaml --quiet --threads 1 --output slow
same slow "a run by halves"
FAULT_LARGER=300000000 trickle slower run bar.yaml --quiet --threads 1 --output slower
same slower "a run with large results by halves"
cp -r half faulty
trickle faulty run bar.yaml --quiet --threads 1 --output faulty --restart
same faulty "a restart by halves"
trickle slow plot slow --field damage --output slow.png
"$breccia" plot whole --field damage --output whole.png > out 2>&1
equal "a picture by halves" "$(cksum < slow.png)" "$(cksum < whole.png)"

# A picture that cannot be written: the others and all else are, and the status tells.
sed 's/^pictures: .*/pictures: [{field: damage}, {curve: "end.time : end.x"}]/' bar.yaml > drawn.yaml
pictures() { # pictures [NUMBER]: one run whose NUMBERth call on a picture fails, in each process
  rm -rf drawn drawn-count
  FAULT_FOLDER="$work/drawn/pictures" FAULT_COUNT="$work/drawn-count" FAULT_AT=$1 FAULT_ERROR=28 LD_PRELOAD=./libio_faults.so \
    "$breccia" run drawn.yaml --quiet --threads 1 --output drawn > out 2>&1
}
pictures 0; equal "pictures: status" $? 0
equal "pictures" "$(ls drawn/pictures | tr '\n' ' ')" "damage.png end.png "
drawn=$(wc -c < drawn-count)
[ "$drawn" -ge 5 ] || fail "only $drawn calls on pictures were seen"
for number in $(seq 1 "${IO_FAULTS:-3}" "$drawn"); do
  pictures "$number"
  status=$?
  if [ $status = 0 ]; then # each process counts for itself, and none came so far
    equal "pictures, call $number: made" "$(ls drawn/pictures | tr '\n' ' ')" "damage.png end.png "
    break
  fi
  checks=$((checks + 4))
  [ $status = 1 ] || fail "pictures, call $number: status $status: $(cat out)"
  [ "$(grep -Ec '^drawn/pictures/[a-z]*.png: (cannot be written|not drawn): ' out)" = "$(wc -l < out)" ] || fail "pictures, call $number: $(cat out)"
  [ "$(find drawn/pictures -name '*.png' | wc -l)" = $((2 - $(wc -l < out))) ] || fail "pictures, call $number: $(ls drawn/pictures), though $(cat out)"
  [ -z "$(find drawn -name '*.part')" ] || fail "pictures, call $number: left behind: $(find drawn -name '*.part')"
  cmp -s whole/end.csv drawn/end.csv && "$build/tests/compare_results" whole/results.vtkhdf drawn/results.vtkhdf ||
    fail "pictures, call $number: histories or results differ"
  contains "pictures, call $number" "$(cat drawn/summary.json)" '"completed": true'
done
echo "failing writes: $tried tried, $lost lost; $calls calls in a run, $large with a journal, $drawn on pictures$reads"
finish

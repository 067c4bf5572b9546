# A run that was killed at random moments and taken up again ends in the same bits as one never stopped.
. "$(dirname "$0")/common.sh"
cd "$work"
rows=7 to=0.25
cat > plate.yaml <<Y
title: Restart
materials:
  clay: {model: multi-yield-j2, density: 1500, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30 kPa}
body:
  plate: {material: clay, spacing: 0.1, shape: {box: {particles: [26, $rows, 2]}}}
cracks: [{cut: {line: [[1.3, -1], [1.3, $to]]}}]
failure: {critical stretch: 0.01}
loads:
  - {on: {face: x-, layers: 3}, body force: [-700 kN/m3, 0, 0], history: {ramp to: 0.01}}
  - {on: {face: x+, layers: 3}, body force: [700 kN/m3, 0, 0], history: {ramp to: 0.01}}
solve: {explicit: {time step: 1e-4, steps: 1500}}
watch:
  mouth: {opening between: [[1.25, 0, 0], [1.35, 0, 0]], every: 7}
  energy: {energy: yes, every: 50}
results: {number: 13, checkpoint steps: 40, precision: double}
Y
"$breccia" run plate.yaml --output whole > out 2>&1 || fail "the whole run failed: $(cat out)"
[ "$(json whole/summary.json broken_bonds)" -gt 0 ] || fail "no bond breaks, the test is too tame"

same() { # same FOLDER: all that a run leaves is as in the whole run
  for file in mouth.csv energy.csv; do
    cmp -s "whole/$file" "$1/$file" || fail "$1: $file differs"
    checks=$((checks + 1))
  done
  "$build/tests/compare_results" whole/results.vtkhdf "$1/results.vtkhdf" || fail "$1: results differ"
  "$build/tests/compare_results" whole/checkpoint.h5 "$1/checkpoint.h5" || fail "$1: checkpoints differ"
  checks=$((checks + 2))
}

# stopped by --steps, then taken up with another number of threads
"$breccia" run plate.yaml --output parts --steps 333 --threads 1 > out 2>&1
"$breccia" run plate.yaml --output parts --steps 801 --restart --threads 2 > out 2>&1 || fail "restart: $(cat out)"
"$breccia" run plate.yaml --output parts --restart > out 2>&1 || fail "restart: $(cat out)"
same parts

# a run whose steps have become more than were foreseen does not end with the number foreseen
foresees() {
  cat > longer.yaml <<'Z'
materials: {steel: {model: elastic, Young modulus: 190 GPa, Poisson ratio: 0.3, density: 8000}}
body: {plate: {material: steel, lattice: square, thickness: 0.01, spacing: 0.002, shape: {box: {from: [0, 0], to: [0.1, 0.2]}}}}
cracks: [{cut: {line: [[-0.001, 0.074], [0.05, 0.074]]}}, {cut: {line: [[-0.001, 0.126], [0.05, 0.126]]}}]
peridynamics: {space: plane strain}
failure: {critical stretch: 0.006, near grips: break}
loads: [{on: {inside: {box: {from: [-0.001, 0.075], to: [0.002, 0.125]}}}, velocity: [16.5, free]}]
solve: {explicit: {end time: 60 us}}
pictures: [{field: damage, at: [1.2345 us, 33 us, 59.9999 us]}]
results: {times: [7.3 us, 33.33 us], number: 3}
Z
  "$breccia" run longer.yaml --output longer > out 2>&1 || fail "longer: $(cat out)"
  most=$(json longer/summary.json steps)
  "$breccia" run longer.yaml --output shorter --steps $((most - 3)) > out 2>&1 || fail "shorter: $(cat out)"
  equal "steps beyond those foreseen" "$(json shorter/summary.json steps)" $((most - 3))
  "$breccia" run longer.yaml --output shorter --restart > out 2>&1 || fail "shorter: $(cat out)"
  equal "restart beyond the steps foreseen" "$(json shorter/summary.json steps)" "$most"
  # states that were written while steps were longer stay
  "$build/tests/compare_results" longer/results.vtkhdf shorter/results.vtkhdf || fail "shorter: results differ"
}
[ -n "${BRECCIA_SANITIZED:-}" ] || foresees # it takes long there, and is about numbers

# a time of the results half way between two steps belongs to the second of them, whatever roundings say
cat > between.yaml <<'Z'
materials: {m: {model: elastic, Young modulus: 1 kPa, Poisson ratio: 0.2, density: 2000}}
body: {b: {material: m, spacing: 1, shape: {box: {particles: [6, 4, 4]}}}}
loads: [{on: {face: x+}, force: [10, 0, 0]}]
solve: {explicit: {time step: 0.1, steps: 5}}
results: {number: 2}
Z
"$breccia" run between.yaml --output straight > out 2>&1 || fail "between: $(cat out)"
for step in 2 3; do
  "$breccia" run between.yaml --output stopped --steps $step > out 2>&1 || fail "between: $(cat out)"
  "$breccia" run between.yaml --output stopped --restart > out 2>&1 || fail "between: $(cat out)"
  "$build/tests/compare_results" straight/results.vtkhdf stopped/results.vtkhdf || fail "stopped at $step: results differ"
  "$build/tests/compare_results" stopped/results.vtkhdf straight/results.vtkhdf || fail "stopped at $step: more results"
  checks=$((checks + 1))
done

# a run that begins again removes the checkpoint of the one before
mkdir straight/deck.yaml.part
"$breccia" run between.yaml --output straight > out 2>&1 && fail "deck.yaml could be written"
[ -e straight/checkpoint.h5 ] && fail "the checkpoint of the run before is left beside new results"
rmdir straight/deck.yaml.part

# bonds that remember, particles that stand anywhere, and contact
{
  echo x,y,z,volume
  for k in 0 1 2 3; do for j in 0 1 2 3; do for i in 0 1 2 3 4 5 6 7 8 9; do
    echo "$i.0$(((i * 7 + j * 3 + k) % 10)),$j.0$(((i * 3 + j * 5 + k * 7) % 10)),$k.0$(((i + j * 9 + k) % 10)),1"
  done; done; done
} > grains.csv
cat > bonds.yaml <<'Y'
title: Bonds
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 30 kN/m}
  s: {model: elastic-1d, density: 2.4, Young modulus: 30 GPa}
body:
  grains: {material: c, spacing: 1, file: grains.csv}
  more: {material: s, spacing: 1, shape: {box: {from: [9.6, -0.5, -0.5], to: [14.6, 3.5, 3.5]}}}
  hammer: {material: s, spacing: 1, shape: {box: {from: [6, 8, 0], to: [8, 10, 2]}}}
peridynamics: {formulation: bond-based, calibration: continuum}
contact: {friction: 0.3}
loads:
  - {on: {face: x-, layers: 2}, velocity: [0, 0, 0]}
  - {on: {block: more}, velocity: [10, 0, 0], history: {ramp to: 0.002}}
  - {on: {block: hammer}, velocity: [0, -80, 0]}
solve: {explicit: {steps: 300}}
results: {number: 5, checkpoint steps: 37, precision: double, fields: [displacement, damage, bond damage]}
Y
"$breccia" run bonds.yaml --output whole-bonds > out 2>&1 || fail "bonds: $(cat out)"
[ "$(json whole-bonds/summary.json broken_bonds)" -gt 0 ] || fail "no bond breaks, the test is too tame"
"$breccia" run bonds.yaml --output part-bonds --steps 231 --threads 1 > out 2>&1
"$breccia" run bonds.yaml --output part-bonds --restart > out 2>&1 || fail "restart: $(cat out)"
for file in results.vtkhdf checkpoint.h5; do
  "$build/tests/compare_results" whole-bonds/$file part-bonds/$file || fail "bonds: $file differs"
  checks=$((checks + 1))
done

# halves of two formulations, which part where they are joined
cat > halves.yaml <<'Y'
title: Halves
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.25, yield stress: 2 MPa, hardening modulus: 1 GPa}
body:
  left: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}
  right: {material: s, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0.2, 0], to: [0.4, 0.1]}}}
peridynamics: {space: plane strain, regions: {fibres: {blocks: [left], formulation: bond-based}}}
failure: {critical stretch: 3e-4}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {face: x+, layers: 3}, velocity: [0.5, free]}
solve: {explicit: {steps: 300}}
results: {number: 5, checkpoint steps: 37, precision: double, fields: [displacement, damage, stress]}
Y
"$breccia" run halves.yaml --output whole-halves > out 2>&1 || fail "halves: $(cat out)"
[ "$(json whole-halves/summary.json broken_bonds)" -gt 0 ] || fail "no bond breaks, the test is too tame"
"$breccia" run halves.yaml --output part-halves --steps 231 --threads 1 > out 2>&1
"$breccia" run halves.yaml --output part-halves --restart > out 2>&1 || fail "restart: $(cat out)"
for file in results.vtkhdf checkpoint.h5; do
  "$build/tests/compare_results" whole-halves/$file part-halves/$file || fail "halves: $file differs"
  checks=$((checks + 1))
done

# a body at rest that softens, stopped after its equations have come to be solved in another way than at first
cat > strip.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
body:
  strip: {material: c, spacing: 5 mm, lattice: square, thickness: 0.1, shape: {box: {particles: [53, 10], first particle: [0, 0]}}}
cracks: [{cut: {line: [[0.1325, -1], [0.1325, 0.0175]]}}]
peridynamics: {space: plane stress, formulation: bond-based}
failure: {near grips: hold}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, displacement: [6e-5, free], history: {ramp to: 1}}
solve: {static: {increments: 6}}
watch: {mouth: {opening between: [[0.13, 0], [0.135, 0]], every: 1}, energy: {energy: yes, every: 1}}
results: {number: 4, precision: double}
pictures: []
Y
# stages of all solvers, stopped in each of them
cat > stages.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.25, yield stress: 2 MPa, hardening modulus: 1 GPa}
body:
  left: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {particles: [9, 5], first particle: [0, 0]}}}
  right: {material: s, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {particles: [9, 5], first particle: [0.09, 0]}}}
cracks: [{cut: {line: [[0.045, -1], [0.045, 0.015]]}}]
peridynamics: {space: plane strain, regions: {fibres: {blocks: [left], formulation: bond-based}}}
failure: {critical stretch: 3e-4, near grips: break}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, displacement: [2e-5, free], history: {ramp to: 1}}
solve:
  - {name: pull, static: {increments: 12}}
  - {name: swing, implicit: {end time: 1e-4, time step: 1e-5}}
  - {name: shake, explicit: {steps: 20, stiffness damping: 1e-7}}
  - {name: rest, static: {method: relaxation, increments: 4}}
watch: {mouth: {opening between: [[0.04, 0], [0.05, 0]], every: 1}, energy: {energy: yes, every: 1}}
profiles: {strip: {of: {all: yes}, along: x}}
results: {number: 4, precision: double}
pictures: []
Y
# stages.yaml with bonds that crush: a restart computes the pressure across them again
sed 's/exponential-softening/fib-concrete, compressive strength: 12 MPa/; s/yield stress: 2 MPa/yield stress: 40 MPa/; s/2e-5, free/-1.2e-4, free/' \
  stages.yaml > crushed.yaml
# ground that begins under its weight, at rest and shaken
cat > ground.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  s: {model: mohr-coulomb, density: 1.9, Young modulus: 40 MPa, Poisson ratio: 0.3, cohesion: 2 kPa, friction angle: 33 deg}
body: {ground: {material: s, lattice: square, spacing: 0.25, thickness: 1, shape: {box: {from: [0, 0], to: [3, 2]}}}}
peridynamics: {space: plane strain}
initial stress: {surface: 2, K0: 0.5}
loads:
  - {gravity: [0, -9.81]}
  - {on: {face: x-}, support: {held: across}}
  - {on: {face: x+}, support: {held: across}}
  - {on: {face: y-}, support: {held: all}}
solve:
  - {name: at rest, static: {increments: 2}}
  - {name: loaded, displacements: zero, loads: [{on: {all of: [{face: y+}, {inside: {box: {from: [1, 0], to: [2, 2]}}}]}, force: [0, -30], history: {ramp to: 1}}],
     static: {increments: 4}}
  - {name: shaken, loads: [{base acceleration: [3, 0]}], explicit: {steps: 20}}
watch: {mouth: {opening between: [[1.125, 1.875], [2.125, 1.875]], every: 1}, energy: {energy: yes, every: 1}}
results: {number: 4, precision: double}
pictures: []
Y
# a bar of metal that comes to its strength at rest, flows on in motion, and is at rest again
cat > handed.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening modulus: 0}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}
peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}
loads:
  - {on: {face: x-}, support: {held: across}}
  - {on: {face: y-}, support: {held: across}}
  - {on: {face: z-}, support: {held: across}}
  - {name: pull, on: {face: x+, layers: 1}, traction: [12, 0, 0], history: {ramp to: 1}}
solve:
  - {static: {increments: 12, no equilibrium: next stage}}
  - {name: flow, loads: [{name: pull, on: {face: x+, layers: 1}, traction: [11, 0, 0], history: {table: [[0, 1], [0.2, 1], [0.3, 0.4545454545]]}}],
     explicit: {steps: 60, local damping: 0.8}}
  - {loads: [{name: pull, on: {face: x+, layers: 1}, traction: [9, 0, 0], history: {table: [[0, 0.5555555556], [1, 1]]}}], static: {increments: 2}}
watch: {mouth: {opening between: [[0.05, 0.15, 0.15], [0.85, 0.15, 0.15]], every: 1}, energy: {energy: yes, every: 1}}
results: {number: 4, precision: double}
pictures: []
Y
cp "$source/tests/command/decks/bars.yaml" .
stop_at() { # stop_at DECK STEP ...: stopped there (under sanitizers only at the last) and taken up again, it ends as in one go
  local deck=$1 steps file again=
  shift
  [ -z "${BRECCIA_SANITIZED:-}" ] || shift $(($# - 1))
  "$breccia" run $deck.yaml --output whole-$deck > out 2>&1 || fail "$deck: $(cat out)"
  for steps in "$@" 1000; do
    "$breccia" run $deck.yaml --output stopped-$deck --steps $steps $again > out 2>&1 || fail "$deck, to step $steps: $(cat out)"
    again=--restart
  done
  for file in mouth.csv energy.csv solution.txt; do
    cmp -s whole-$deck/$file stopped-$deck/$file || fail "$deck: $file differs"
    checks=$((checks + 1))
  done
  for file in results.vtkhdf checkpoint.h5; do
    "$build/tests/compare_results" whole-$deck/$file stopped-$deck/$file || fail "$deck: $file differs"
    checks=$((checks + 1))
  done
}
if [ -z "${BRECCIA_SANITIZED:-}" ]; then # a fifth of the time there, and solvers are stopped in stages as well
  stop_at strip 2 4
  grep -q "the body does not resist some motion" whole-strip/solution.txt || fail "strip: no equations are hard to solve, the test is too tame"
fi
stop_at stages 4 8 16 31 44
[ "$(json whole-stages/summary.json broken_bonds)" -gt 0 ] || fail "stages: no bond breaks, the test is too tame"
cmp -s whole-stages/profiles/strip.csv stopped-stages/profiles/strip.csv || fail "stages: a profile differs"
[ "$(wc -l < whole-stages/profiles/strip.csv)" = 19 ] || fail "stages: a profile of 18 layers: $(cat whole-stages/profiles/strip.csv)"
if [ -z "${BRECCIA_SANITIZED:-}" ]; then
  stop_at crushed 9 31
  awk -v damage="$(json whole-crushed/summary.json dissipated)" 'BEGIN {exit !(damage > 0)}' || fail "crushed: nothing is crushed, the test is too tame"
fi
stop_at ground 1 4 16
stop_at bars 1 5 9 30
[ "$(json whole-bars/summary.json broken_bonds)" -gt 0 ] || fail "bars: no bond breaks, the test is too tame"
cmp -s whole-bars/bars/bars.csv stopped-bars/bars/bars.csv || fail "bars: strains and stresses along bars differ"
stop_at handed 6 20 50
grep -q '"times": .*"at_rest": false}, {"name": "flow"' whole-handed/summary.json || fail "handed: what found no rest is told as at rest: $(grep '"stages"' whole-handed/summary.json)"
checks=$((checks + 1))
tail -n 30 whole-handed/solution.txt | grep -q "no equilibrium:" || fail "handed: the body finds rest, the test is too tame"
# what the log tells of steps behind the checkpoint is cut
"$breccia" run stages.yaml --output stopped-stages --steps 44 > out 2>&1
head -c 2000 whole-stages/solution.txt >> stopped-stages/solution.txt
"$breccia" run stages.yaml --output stopped-stages --restart > out 2>&1 || fail "stages: $(cat out)"
equal "solution.txt beyond the checkpoint" "$(cksum < stopped-stages/solution.txt)" "$(cksum < whole-stages/solution.txt)"

# and must hold what it told before
"$breccia" run stages.yaml --output kept-stages --steps 8 > out 2>&1 || fail "stages: $(cat out)"
for case in 'removed' 'shortened'; do
  rm -rf stopped-stages; cp -r kept-stages stopped-stages
  if [ $case = removed ]; then rm stopped-stages/solution.txt; else truncate -s 40 stopped-stages/solution.txt; fi
  "$breccia" run stages.yaml --output stopped-stages --restart > /dev/null 2> out; equal "solution.txt $case: status" $? 2
  contains "solution.txt $case" "$(cat out)" "stopped-stages/solution.txt: "
  contains "solution.txt $case" "$(cat out)" "or run without --restart"
  equal "solution.txt $case: lines" "$(wc -l < out)" 1
done

# interrupted and killed at random moments
RANDOM=7
signals="INT KILL"
[ -n "${BRECCIA_WHOLE:-}" ] && signals="INT HUP TERM XCPU KILL"
[ -n "${BRECCIA_SANITIZED:-}" ] && signals=TERM
for signal in $signals; do
  rm -rf killed
  "$breccia" run plate.yaml --output killed > out 2>&1 &
  for attempt in 1 2 3; do
    pid=$!
    sleep "0.$((RANDOM % 30 + 10))"
    kill -$signal $pid 2> /dev/null
    wait $pid 2> /dev/null
    status=$?
    # On a slow machine the signal may come before the program has begun to listen; then it has said nothing yet.
    case $status in 129 | 143 | 152) [ -s out ] || status=0 ;; esac
    [ $signal = KILL ] || [ $status = 130 ] || [ $status = 0 ] || fail "$signal: exit status $status: $(cat out)"
    [ $signal = KILL ] || [ $status = 0 ] || contains "$signal" "$(cat out)" "--restart' goes on from here"
    if [ -e killed/checkpoint.h5 ]; then
      "$breccia" run plate.yaml --output killed --restart > out 2>&1 &
    else
      "$breccia" run plate.yaml --output killed > out 2>&1 &
    fi
  done
  wait $! || fail "$signal: the last restart failed: $(cat out)"
  same killed
done

# one run, one folder: a second one is told who is there, and a run that was killed is in nobody's way
sed 's/steps: 1500/steps: 1000000/' plate.yaml > long.yaml
"$breccia" run long.yaml --output held > out 2>&1 &
first=$!
wait_for $first [ -e held/checkpoint.h5 ]
"$breccia" run long.yaml --output held > /dev/null 2> second; equal "a held folder: status" $? 2
contains "a held folder" "$(cat second)" "held: another run writes into this folder (process $first on $(uname -n) since 20"
equal "a held folder: lines" "$(wc -l < second)" 1
"$breccia" run long.yaml --output held --restart > /dev/null 2> second; equal "a held folder, restart: status" $? 2
kill -KILL $first
wait $first 2> /dev/null
[ -e held/run.lock ] || fail "the lock of a killed run is gone, the test is too tame"
"$breccia" run long.yaml --output held --restart --steps 200 > out 2>&1 || fail "after a kill: $(cat out)"
[ -e held/run.lock ] && fail "a run that has ended leaves its lock"
checks=$((checks + 2))

# what does not fit is refused with the reason
sed 's/steps: 1500/steps: 1600/' plate.yaml > other.yaml
"$breccia" run other.yaml --output parts --restart > /dev/null 2> out; equal "another deck: status" $? 2
contains "another deck" "$(cat out)" "was written with another deck"
sed 's/\[26, /[25, /' plate.yaml > other.yaml
"$breccia" run other.yaml --output parts --restart > /dev/null 2> out; equal "another body: status" $? 2
contains "another body" "$(cat out)" "was written with another deck"
"$breccia" run plate.yaml --output nowhere --restart > /dev/null 2> out; equal "no checkpoint: status" $? 2
contains "no checkpoint" "$(cat out)" "there is no checkpoint to restart from"
head -c 3000 whole/checkpoint.h5 > parts/checkpoint.h5
"$breccia" run plate.yaml --output parts --restart > /dev/null 2> out; equal "damaged checkpoint: status" $? 2
contains "damaged checkpoint" "$(cat out)" "checkpoint.h5: is damaged"
contains "damaged checkpoint" "$(cat out)" "of step 1480, is whole: --restart-before goes on from that"
equal "damaged checkpoint: lines" "$(wc -l < out)" 1
"$breccia" run plate.yaml --output parts --restart-before > out 2>&1 || fail "restart from the one before: $(cat out)"
same parts
# histories: rows beyond the checkpoint go, rows that are missing are refused
"$breccia" run plate.yaml --output parts --steps 801 > out 2>&1 || fail "parts: $(cat out)"
echo '805,0.1,0.2,0.3' >> parts/mouth.csv
cp parts/mouth.csv mouth.kept; cp parts/energy.csv energy.kept; cp parts/results.vtkhdf results.kept
refused() { # refused WHAT WORDS: with one line, and nothing lost by the attempt
  rm -rf before; cp -r parts before
  "$breccia" run plate.yaml --output parts --restart > /dev/null 2> out; equal "$1: status" $? 2
  contains "$1" "$(cat out)" "$2"
  equal "$1: lines" "$(wc -l < out)" 1
  diff -rq before parts || fail "$1: the attempt changed files"
  cp mouth.kept parts/mouth.csv; cp energy.kept parts/energy.csv; cp results.kept parts/results.vtkhdf
}
rm parts/mouth.csv; refused "a history is missing" "mouth.csv: No such file"
changed="its rows up to step 801, from which the run goes on, are not all as they were written"
sed -i 5d parts/mouth.csv; refused "a row is missing" "mouth.csv: $changed"
head -c -20 mouth.kept | head -n -2 > parts/mouth.csv; refused "the end is missing" "mouth.csv: $changed"
sed -i '4s/,[^,]*$//' parts/energy.csv; refused "a row is short" "energy.csv: $changed"
sed -i '5s/\([1-9]\)\([^0-9]*\)$/0\2/' parts/mouth.csv; refused "a digit is another" "mouth.csv: $changed"
sed -i 's/$/\r/' parts/mouth.csv; refused "lines end otherwise" "mouth.csv: $changed"
"$breccia" run plate.yaml --set 'materials.clay.density=1600' --output denser --steps 801 > out 2>&1 || fail "denser: $(cat out)"
cp denser/mouth.csv parts/; refused "a history of another run" "mouth.csv: $changed"
cp denser/results.vtkhdf parts/; refused "results of another run" "results.vtkhdf: holds results of another deck"
"$breccia" run plate.yaml --output early --steps 300 > out 2>&1 || fail "early: $(cat out)"
cp early/results.vtkhdf parts/; refused "an earlier result file" "results.vtkhdf: lacks the state of step"
"$breccia" run plate.yaml --output sparse --set results.number=1 --set results.every=346 --steps 700 > out 2>&1 || fail "sparse: $(cat out)"
cp sparse/results.vtkhdf parts/; refused "states are missing" "results.vtkhdf: has 3 states up to step 692, of which 7 were written"
"$breccia" run plate.yaml --output parts --restart > out 2>&1 || fail "restart: $(cat out)"
same parts
cp grains.csv kept.csv
sed '3s/,0\./,0.1/' kept.csv > grains.csv
"$breccia" run bonds.yaml --output part-bonds --restart > /dev/null 2> out; equal "another file of particles: status" $? 2
contains "another file of particles" "$(cat out)" "grains.csv: has changed since"
cp kept.csv grains.csv
"$breccia" run bonds.yaml --output part-bonds --restart > out 2>&1 || fail "the file of particles as it was: $(cat out)"
finish

# The load under which a body fails: found between two loads, in any way that a body can fail.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
# A bar that yields and does not harden bears its strength times its area, 250 MPa x 4 cm2 = 100 kN.
cat > bar.yaml <<'Y'
variables: {pull: 50 kN}
units: {length: m, force: kN, time: s}
materials: {steel: {model: elastic-perfectly-plastic, density: 7.85, Young modulus: 200 GPa, yield stress: 250 MPa}}
body: {bar: {material: steel, lattice: line, spacing: 10 mm, area: 4 cm2, shape: {box: {particles: [30, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, 0]}
  - {on: {face: x+, layers: 3}, force: ["${pull}", 0]}
solve: {static: {}}
Y
bracket() { sed -n 's/^fails between \([0-9.]*\)[^(]* and \([0-9.]*\).*/\1 \2/p' "$1"; }
"$breccia" failure bar.yaml --load 'variables.pull=50 kN:200 kN' --within 0.02 > out 2> errors
equal "a bar that yields: status" $? 0
bracket out | awk '{exit !($1 > 95 && $1 <= 100.001 && $2 >= 99.9 && $2 <= $1 / 0.98 + 1e-3)}' || fail "a bar that yields: $(cat out errors)"
equal "heading of the table" "$(head -1 bar-failure/failure.csv)" 'step,load (kN),outcome,displacement (m),rate,plastic share,share of control,forces out of balance,kinetic energy,time held (s),case'
equal "loads in their order" "$(tail -n +2 bar-failure/failure.csv | cut -d, -f2 | sort -n | cmp - <(tail -n +2 bar-failure/failure.csv | cut -d, -f2) && echo yes)" yes
grep -q '^[0-9]*,200,stopped,,,,,,,,pull-200-kN$' bar-failure/failure.csv || fail "the load beyond: $(cat bar-failure/failure.csv)"
grep -q '^stopped: the run ended before its time' out || fail "what stopped means: $(cat out)"
# One at a time the middle is tried; what is done is not run again.
"$breccia" failure bar.yaml --load 'variables.pull=50 kN:200 kN' --within 0.1 --jobs 1 > one 2> errors || fail "one at a time: $(cat one errors)"
grep -q 'pull-50-kN: was done' one || fail "cases that were done: $(cat one)"
bracket one | awk '{exit !($1 <= 100.001 && $2 >= 99.9 && $2 <= $1 / 0.9 + 1e-3)}' || fail "one at a time: $(cat one errors)"
# The same bar pushed: loads below zero are as many and as large.
"$breccia" failure bar.yaml --load 'variables.pull=-50 kN:-200 kN' --within 0.1 --jobs 1 --output pushed > pushed.out 2> errors
equal "a bar that is pushed: status" $? 0
equal "a bar that is pushed" "$(sed -n 's/^fails between -\([0-9.]*\)[^(]* and -\([0-9.]*\).*/\1 \2/p' pushed.out)" "$(bracket one)"
equal "loads of a bar that is pushed" "$(tail -n +2 pushed/failure.csv | cut -d, -f2,3)" "$(tail -n +2 bar-failure/failure.csv | cut -d, -f2,3 | sed 's/^/-/')"
# A pull that grows, falls and grows again with the load: the bar fails from 87.5 kN on, bears 150 kN and fails under 200 kN.
sed 's/force: \["${pull}"/force: ["${max(50 kN, 150 kN - 4 * abs(pull - 100 kN), 4 * (pull - 150 kN))}"/' bar.yaml > again.yaml
"$breccia" failure again.yaml --load 'variables.pull=50 kN:200 kN' --within 0.1 > out 2> errors
equal "a bar that bears again: status" $? 0
bracket out | awk '{exit !($1 > 75 && $1 <= 87.501 && $2 >= 87.499 && $2 < 97)}' || fail "a bar that bears again: $(cat out errors)"
grep -q '^outcomes are not monotonic: it also bears 150 kN at or above a load under which it fails; of the [0-9]* runs from 88.[89]*[ 0-9]*kN to 150 kN [0-9]* fail' out || fail "the load above: $(cat out errors)"
# Concrete as a lattice of beams, pulled by a ramp of two periods and held for one more: 360 N a particle (Tuniki 2012, Table 4.1).
cat > plate.yaml <<'Y'
variables: {load: 300 N, period: 0.66 ms}
materials: {concrete: {model: link-damage, density: 2400 kg/m3, Young modulus: 3.605e6 psi, Poisson ratio: 0.2, tensile stretch: 6.034e-5, compressive stretch: 6.1875e-4, stiffness recovery: 0}}
body: {plate: {material: concrete, lattice: hexagonal, spacing: 1 in, thickness: 1 in, shape: {box: {particles: [16, 53]}}}}
peridynamics: {formulation: micropolar, space: plane stress}
loads:
  - {on: {face: y-, layers: 3}, force: [0, "${-48 * load}"], history: {ramp to: "${2 * period}"}}
  - {on: {face: y+, layers: 3}, force: [0, "${48 * load}"], history: {ramp to: "${2 * period}"}}
solve: {explicit: {end time: "${3 * period}", damping: {ratio: 1, at: "${1 / period}"}}}
Y
"$breccia" failure plate.yaml --load 'variables.load=300 N:440 N' --within 0.02 --quiet > out 2> errors || fail "plate: $(cat out errors)"
bracket out | awk '{exit !($1 > 342 && $2 < 378)}' || fail "a plate of links: $(cat out errors)"
# A disk that is full is no load that is too large: it is said, with status 1, and tried again the next time.
cat > elastic.yaml <<'Y'
variables: {pull: 50 kN}
units: {length: m, force: kN, time: s}
materials: {steel: {model: elastic-1d, density: 7.85, Young modulus: 200 GPa}}
body: {bar: {material: steel, lattice: line, spacing: 1 mm, area: 4 cm2, shape: {box: {particles: [3000, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, 0]}
  - {on: {face: x+, layers: 3}, force: ["${pull}", 0]}
solve: {static: {}}
Y
(ulimit -f 40; "$breccia" failure elastic.yaml --load 'variables.pull=50 kN:200 kN' > out 2> errors)
equal "a full disk: status" $? 1
grep -q 'cannot be written' errors || fail "a full disk: $(cat out errors)"
"$breccia" failure elastic.yaml --load 'variables.pull=50 kN:200 kN' > out 2> errors
equal "a bar that does not fail: status" $? 2
grep -q 'the body does not fail under 200 kN; give a larger TO' errors || fail "a bar that does not fail: $(cat out errors)"
grep -q 'was done' out && fail "cases without space for their files count as done: $(cat out)"
# ---- displacement jumps at 100 kN, then grows at the former rate; from 50 to 400 kN only 1.3 times as fast ----
sed 's/force: \["${pull}"/force: ["${pull + 100 * min(1 kN, max(0 kN, pull - 100 kN))}"/' elastic.yaml > jump.yaml
sed -i 's/1 mm, area/10 mm, area/; s/\[3000, 1\]/[30, 1]/' jump.yaml
"$breccia" failure jump.yaml --load 'variables.pull=50 kN:400 kN' --within 0.02 --quiet > out 2> errors
equal "a bar that jumps: status" $? 0
bracket out | awk '{exit !($1 > 90 && $1 <= 101 && $2 >= 100 && $2 < 110)}' || fail "a bar that jumps: $(cat out errors)"
# What is wrong is said, with status 2.
# ---- a body that is slower than its loading: what counts as failed and still came to rest is told ----
cat > slow.yaml <<'DECK'
units: {length: m, force: kN, time: s}
variables: {pull: 1}
materials: {m: {model: steel-bilinear, Young modulus: 1e6, density: 2, yield stress: 80, hardening ratio: 0.05}}
body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [40, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D, surface correction: energy}
loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {on: {face: x+, layers: 3}, force: ["${pull}", 0]}]
solve: {explicit: {quasi-static: {}}}
DECK
"$breccia" failure slow.yaml --load variables.pull=0.7:1.1 --within 0.2 > out 2>&1; equal "a slow body: status" $? 0
grep -q "under 1.1 it still came to rest when the run ended: a longer 'longest hold'" out || fail "a slow body: $(cat out)"
grep -q "under 0.7 it still" out && fail "what it bears is called slow: $(cat out)"
# ---- verdicts by more than rest ----
# J2 in plane stress, whose control of zero-energy modes keeps its stiffness: at rest under 80 times its yield load of 3 MPa x 0.08 m x 0.1 m = 24 kN.
cat > control.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {c: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, yield stress: 3 MPa}}
body: {beam: {material: c, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {particles: [8, 4], first particle: [0, 0]}}}}
peridynamics: {formulation: correspondence, space: plane stress}
variables: {p: 10 kN}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {name: pull, on: {face: x+, layers: 1}, force: ["${p}", 0], history: {ramp to: 1}}
solve: {static: {increments: 2, method: relaxation, residual: 1e-4}}
results: {number: 1}
pictures: []
Y
"$breccia" failure control.yaml --load 'variables.p=10 kN:1920 kN' --within 0.3 > out 2> errors
equal "a bar held by control: status" $? 0
sed -n 's/^bears \([0-9.]*\) kN; no verdict from \([0-9.]*\) kN on .*: control of zero-energy modes carries load.*/\1 \2/p; s/^fails between \([0-9.]*\) kN and \([0-9.]*\) kN.*/\1 \2/p' out |
  awk '{good = $1 >= 20 && $1 < 48} END {exit !good}' || fail "a bar held by control bears more than twice its yield load: $(cat out errors)"
grep -q '^ *1920 kN  no verdict' out || grep -q '^ *1920 kN  gives way' out || fail "80 times the yield load: $(cat out errors)"
# A bar that hardens with a 200th of its stiffness comes to rest at all loads, but gives way at its yield load of 100 kN; with a larger --rate it bears 120 kN.
sed 's/model: elastic-perfectly-plastic,/model: steel-bilinear, hardening ratio: 0.005,/' bar.yaml > hardening.yaml
"$breccia" failure hardening.yaml --load 'variables.pull=50 kN:120 kN' --within 0.05 > out 2> errors
equal "a bar that hardens: status" $? 0
bracket out | awk '{exit !($1 > 90 && $1 < 105 && $2 > 99.9 && $2 < 110)}' || fail "a bar that hardens: $(cat out errors)"
grep -q '^gives way: displacement grows too fast' out || fail "a bar that hardens gives way: $(cat out)"
refused_by_rate=$("$breccia" failure hardening.yaml --load 'variables.pull=50 kN:120 kN' --rate 300 2>&1)
contains "a larger rate" "$refused_by_rate" "does not fail under 120 kN; give a larger TO"
# A body that has failed carries no larger load: the bar carries 130 kN at most and moves no further.
sed 's/force: \["${pull}"/force: ["${min(pull, 130 kN)}"/' hardening.yaml > stopped.yaml
"$breccia" failure stopped.yaml --load 'variables.pull=50 kN:200 kN' --within 0.1 --jobs 1 > out 2> errors
equal "a bar that goes no further: status" $? 0
grep -q '^ *200 kN  gives way' out || fail "a bar that has given way bears 200 kN: $(cat out errors)"
# Strengths of 100, 104 and 108 kN by three seeds: at least half of them fail from 104 kN on.
sed -e 's/pull: 50 kN/pull: 50 kN, seed: 0/' -e 's/yield stress: 250 MPa/yield stress: "${250 MPa + 10 MPa * seed}"/' bar.yaml > seeds.yaml
"$breccia" failure seeds.yaml --load 'variables.pull=90 kN:120 kN' --seed 'variables.seed=0, 1, 2' --within 0.01 > out 2> errors
equal "three seeds: status" $? 0
bracket out | awk '{exit !($1 > 102 && $1 <= 104.001 && $2 >= 103.9 && $2 < 106)}' || fail "three seeds: $(cat out errors)"
grep -q '^under 120 kN 3 of 3 runs fail' out && grep -q '^under 90 kN 0 of 3 runs fail' out && grep -q ' 1 of 3 runs fail' out || fail "shares of three seeds: $(cat out)"
# Samples: 2 more loads, evenly spaced.
"$breccia" failure bar.yaml --load 'variables.pull=50 kN:200 kN' --within 0.3 --samples 2 --output sampled > out 2> errors
equal "samples: status" $? 0
grep -q '^ *100 kN ' out && grep -q '^ *150 kN ' out || fail "samples: $(cat out errors)"
# Ground on a slope without end slides where strengths are divided by c / (gamma H sin b) + tan(phi) / tan(b) = 0.447 + 0.8 = 1.247.
# With Green-Lagrange strains of 5 % forces before the slide are 5 % smaller.
cat > slope.yaml <<'Y'
units: {length: m, force: kN, time: s}
variables: {factor: 1, g: 10, lean: "${atan(0.5)}"}
materials: {soil: {model: mohr-coulomb, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, cohesion: 40, friction angle: "${atan(0.4)}", dilation angle: 0}}
body: {b: {material: soil, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, 0], to: [4, 10]}}}}
peridynamics: {formulation: correspondence, space: plane strain, horizon: 2.015 spacings, zero-energy control: {silling: 0.2, fades: yielding}}
loads: [{gravity: ["${g*sin(lean)}", "${-g*cos(lean)}"]}, {on: {face: y-}, support: {held: all}}, {on: {face: x+}, support: {held: periodic}}]
solve: [{name: at rest, laws: elastic, static: {increments: 1}},
        {name: weaken, displacements: zero, loads: [{strength reduction: "${factor}", history: {ramp to: 1}}], static: {increments: 4, smallest increment: 0.1}}]
pictures: []
Y
"$breccia" failure slope.yaml --load variables.factor=1:2 --within 0.02 > out 2> errors
equal "a slope without end: status" $? 0
"$breccia" check slope.yaml 2>&1 | grep -q "support: the base is held in all directions below ground that yields" || fail "a held base under ground that slides is not told"
sed -n 's/^factor of safety: between \([0-9.]*\) and .*/\1/p' out | awk '{good = $1 > 1.12 && $1 < 1.31} END {exit !good}' || fail "a slope without end: $(cat out errors)"
# A slope of clay, on ground of half its height, slides at 1.50 by slip circles. With constant influence control of
# zero-energy modes holds the slope beyond that factor, and a run tells from which factor on.
if [ -z "${BRECCIA_SANITIZED:-}" ]; then
  cat > clay.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {clay: {model: j2, density: 2, Young modulus: 1e5, Poisson ratio: 0.49, yield stress: "${sqrt(3)*31.35}"}}
body: {b: {material: clay, lattice: square, spacing: 1, thickness: 1, shape: {polygon: {corners: [[0, 0], [18, 0], [18, 3], [12, 3], [6, 9], [0, 9]]}}}}
peridynamics: {formulation: correspondence, space: plane strain, zero-energy control: {silling: 0.2, fades: yielding}}
loads: [{on: {face: x-}, support: {held: across}}, {on: {face: x+}, support: {held: across}}, {on: {face: y-}, support: {held: all}}, {gravity: [0, -10], history: {ramp to: 1}}]
solve: [{name: at rest, static: {increments: 5}},
        {name: weaken, displacements: zero, loads: [{strength reduction: 1.65, history: {ramp to: 1}}], static: {increments: 5}}]
pictures: []
Y
  "$breccia" run clay.yaml > out 2> errors
  grep -q 'warning: from a factor of 1\.[456][0-9]* on, control of zero-energy modes holds more than 25 % of .*; take no factor of safety above 1\.[345][0-9]*, or take .influence: conical. and .horizon: 2.015 spacings' out errors ||
    fail "ground held by control: $(cat out errors)"
  # With conical influence zero-energy modes let the slope slide early, the more so the longer the horizon.
  for spacings in 2.015 3.015; do
    "$breccia" check clay.yaml --set peridynamics.influence=conical --set peridynamics.horizon="$spacings" > out 2> errors
    grep -q "zero-energy modes let ground slide early" out
    equal "words on zero-energy modes at a horizon of $spacings" $? "$([ $spacings = 2.015 ] && echo 1 || echo 0)"
  done
fi
refused() { # name, words, arguments
  local name=$1 words=$2
  shift 2
  "$breccia" failure "$@" > out 2> errors
  equal "$name: status" $? 2
  grep -q -- "$words" errors || fail "$name: $(cat out errors)"
}
refused "no load" "give the load with --load" bar.yaml
refused "no range" "two numbers of one unit" bar.yaml --load variables.pull=3
refused "a list" "two numbers of one unit" bar.yaml --load 'variables.pull=3 kN, 4 kN:5 kN, 6 kN'
refused "two units" "two numbers of one unit" bar.yaml --load 'variables.pull=3 N:4 kN'
refused "the wrong way" "FROM must be the load that the body bears" bar.yaml --load 'variables.pull=4 kN:3 kN'
refused "within nothing" "takes a number between 0 and 1" bar.yaml --load 'variables.pull=3 kN:4 kN' --within 0
refused "an unknown key" "bul" bar.yaml --load 'variables.bull=3 kN:4 kN'
refused "no rate" "--rate takes a number above 1" bar.yaml --load 'variables.pull=3 kN:4 kN' --rate 1
refused "never fails" "give a larger TO" bar.yaml --load 'variables.pull=10 kN:20 kN'
refused "fails at once" "give a smaller FROM" bar.yaml --load 'variables.pull=300 kN:400 kN'
sed 's/, damping.*}}$/}}/' plate.yaml > free.yaml
refused "undamped" "cannot be told: loads must have become steady" free.yaml --load 'variables.load=10 N:20 N'
sed -e 's/explicit: {.*}}$/explicit: {quasi-static: {ramp: 0.01, hold: 0.1}}}/' -e 's/, history: {ramp to:[^}]*}"}//' plate.yaml > short.yaml
refused "too short to tell" "'quasi-static' time enough; its log.txt tells more" short.yaml --load 'variables.load=10 N:20 N'
grep -q 'not told: .*; the loading is too short to tell' short-failure/*/log.txt || fail "too short to tell: $(cat short-failure/*/log.txt)"
finish

# What a person reads of a body before and after a run, whole lines of it, against closed forms and against counts and sums made here.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

# lines WHAT FILE: each line of the input is a whole line of FILE
lines() {
  local line
  while IFS= read -r line; do
    checks=$((checks + 1))
    grep -qxF -- "$line" "$2" || fail "$1: no line «$line» in: $(cat "$2")"
  done
}

# near WHAT FOUND EXPECTED SHARE
near() {
  checks=$((checks + 1))
  awk -v a="$2" -v b="$3" -v s="$4" 'BEGIN {d = a - b; if (d < 0) d = -d; m = b < 0 ? -b : b; exit !(a != "" && d <= s * m)}' || fail "$1: expected $3, found «$2»"
}

# figures FILE KEY: the number or the list of numbers at a key of a JSON file
figures() {
  sed -n "s/.*\"$2\": \[\([^]]*\)\].*/\1/p; t; s/.*\"$2\": \([-0-9.e+]*\).*/\1/p" "$1" | head -1 | tr -d ,
}

# ---- a bar of two materials ----
cat > rod.yaml <<'Y'
title: Rod
units: {length: mm, force: N, time: ms}
materials:
  stiff: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}
  soft: {model: mazars, density: 1500 kg/m3, Young modulus: 15 GPa, Poisson ratio: 0.2, tensile strength: 3 MPa, fracture energy: 120 J/m2}
body:
  left: {material: stiff, spacing: 20, shape: {box: {from: [0, 0, 0], to: [400, 80, 80]}}}
  right: {material: soft, spacing: 20, shape: {box: {from: [400, 0, 0], to: [600, 80, 80]}}}
loads:
  - {name: held, on: {face: x-}, displacement: [0, free, free]}
  - {name: blow, on: {face: x+}, velocity: [1, 0, 0], history: {ramp to: 0.1 ms}}
  - {name: waves, on: {face: x-}, body force: [0, 1e-6, 0], history: {ramp to: 1}}
  - {on: {face: y+}, body force: [0, 1e-6, 0], history: {ramp to: 20}}
solve: {explicit: {end time: 1}}
pictures: []
Y
"$breccia" check rod.yaml > out 2> errors || fail "rod: $(cat errors)"
# all pairs of 30 x 4 x 4 places nearer than 3.015 spacings
awk 'BEGIN {for (n = 0; n < 480; ++n) for (m = 0; m < 480; ++m) {x = int(n / 16) - int(m / 16); if (x > 3 || x < -3) continue
  y = int(n / 4) % 4 - int(m / 4) % 4; z = n % 4 - m % 4; d = x * x + y * y + z * z; if (d && d <= 9) ++own[n]}
  few = 1e9; for (n = 0; n < 480; ++n) {all += own[n]; if (own[n] < few) few = own[n]; if (own[n] > most) most = own[n]}
  printf "Rod: 480 particles, %d bonds, %d to %d per particle (mean %.1f), horizon 60.3 mm\n", all / 2, few, most, all / 480}' > counted
lines "rod: bonds" out < counted
# 33.3 GPa and 16.7 GPa across; 0.4 m of 2400 and 0.2 m of 1500 kg/m3; 600 mm at 3.727 km/s; sqrt(E / density) = 3.536 km/s
lines "rod" out <<'Y'
correspondence; stiff (elastic), soft (mazars); bonds do not break
body: 600 mm x 80 mm x 80 mm, 8.064 kg; a wave travels through in 161 µs
in SI units:
  stiff: 2400 kg/m3, E 30 GPa, waves 3.73 km/s
  soft: 1500 kg/m3, E 15 GPa, waves 3.33 km/s, fracture energy 120 J/m2, E G_F / f_t^2 200 mm (3.3 horizons)
  lowest frequency of the free body: about 2.95 kHz along, 808 Hz in bending across its thinnest side; 'breccia modes' finds it as the body is held
  load 'blow': grows over 100 µs, 0.621 travel times of a wave: a blow; a wave behind 1 m/s carries 8.94 MPa
  load 'waves': grows over 1 ms, 6.21 travel times of a wave: waves will show
  load in line 13: grows over 20 ms, 124 travel times of a wave: slow
  the run: 1 ms, 6.21 travel times of a wave
Y
grep -q "load 'held'" out && fail "a support has a size: $(cat out)"
"$breccia" run rod.yaml > out 2> errors || fail "run of the rod: $(cat errors)"
s=rod/summary.json
steps=$(figures $s steps)
lines "rod: outcome" out <<Y
load 'held': displacement
load 'blow': velocity, peak 1 mm/ms
load 'waves': body force, peak 1e-06 N/mm3
written:
  rod/deck.yaml (what was run)
  rod/results.vtkhdf (and results.xdmf for older ParaView)
  rod/summary.json
Y
contains "rod: end" "$(cat out)" "finished at step $steps of $steps, time 1 ms; "
contains "rod: step" "$(cat out)" "$steps steps of $(figures $s time_step) ms ($(awk -v a="$(figures $s time_step)" -v b="$(figures $s stable_time_step)" 'BEGIN {printf "%.2f of the stable %.4g", a / b, b}')), "
near "rod: time of a bond" "$(figures $s ns_per_directed_bond_step)" "$(awk -v t="$(figures $s wall_seconds)" -v b="$(figures $s bonds)" -v n="$steps" 'BEGIN {print 1e9 * t / (2 * b * n)}')" 0.02
# a load of 20 ms has come to a twentieth after one; what does not end is as large as it is at the end of the run
contains "rod: load without a name" "$(cat $s)" '{"name": "", "line": 13, "kind": "body force", "peak": 5e-08, "unit": "N/mm3", "largest_force": [0, '
# energies: what is put in is what is there, and the words are those of the file, in joules
near "rod: energies" "$(figures $s external)" "$(awk -v k="$(figures $s kinetic)" -v s="$(figures $s stored)" -v d="$(figures $s dissipated)" 'BEGIN {printf "%.12g", k + s + d}')" 1e-3
near "rod: internal energy" "$(figures $s internal)" "$(awk -v s="$(figures $s stored)" -v d="$(figures $s dissipated)" 'BEGIN {printf "%.12g", s + d}')" 1e-9
words=$(grep '^energy: ' out)
said() { # said WORD: the number before its unit, in joules
  echo "$words" | sed -n "s/.*$1 \([-0-9.e+]*\) \([mµk]*\)J.*/\1 \2/p" | awk '{print $1 * ($2 == "m" ? 1e-3 : $2 == "µ" ? 1e-6 : $2 == "k" ? 1e3 : 1)}'
}
for word in external kinetic stored dissipated fracture; do near "rod: said of $word" "$(said $word)" "$(awk -v e="$(figures $s $word)" 'BEGIN {print e / 1000}')" 0.006; done
case $words in *friction* | *damping* | *"at the start"*) fail "what is none is told: $words" ;; esac
contains "rod: largest" "$(cat out)" "largest in the states written and at the end: displacement 950 µm, octahedral shear stress " # 1 mm/ms over 1 ms, less half the ramp
pascals() { awk '{print $1 * ($2 == "kPa" ? 1e3 : $2 == "MPa" ? 1e6 : $2 == "GPa" ? 1e9 : 1)}'; }
told=$(sed -n 's/^largest in the states.*mean stress \([^,]*\)$/\1/p' out) # the file's are N/mm2
near "rod: lowest mean stress" "$(echo "${told% to *}" | pascals)" "$(awk -v s="$(figures $s mean_stress_lowest)" 'BEGIN {print 1e6 * s}')" 0.006
near "rod: highest mean stress" "$(echo "${told#* to }" | pascals)" "$(awk -v s="$(figures $s mean_stress_highest)" 'BEGIN {print 1e6 * s}')" 0.006

# ---- from rest to motion ----
cat > staged.yaml <<'Y'
title: Staged
units: {length: m, force: kN, time: s}
variables: {size: 2}
materials: {m: {model: elastic, density: "${size}", Young modulus: 1e4, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 8]}}}}
peridynamics: {space: plane strain}
loads: [{on: {face: x-}, displacement: [0, 0]}, {name: pull, on: {face: x+}, traction: [1, 0], history: {ramp to: 0.5}}]
solve:
  - {name: slow, static: {increments: 4}}
  - {name: fast, explicit: {steps: 40}, displacements: zero, laws: elastic, loads: [{name: more, on: {face: y+}, body force: [0, -1]}]}
pictures: []
Y
"$breccia" check staged.yaml --set 'title="Two stages"' > out 2> errors || fail "stages: $(cat errors)"
# 12 x 8 places of 0.1 m, 0.2 m thick; sqrt(12 MPa / 2 t/m3); a pull of 1 kPa on 0.8 m x 0.2 m
lines "stages" out <<'Y'
correspondence; m (elastic); bonds do not break
body: 1.2 m x 800 mm, 384 kg; a wave travels through in 15.5 ms
stage 'slow': static, 4 increments up to time 1 s
stage 'fast': explicit, 40 steps, elastic, displacements from zero, 1 new load
  m: 2000 kg/m3, E 10 MPa, waves 77.5 m/s
  load 'pull': a force in all of 160 N along x; grows over 500 ms of its stage, at rest
  load 'more': acts in full from the start
  the run: steps beside stages at rest, which are as long as the body allows then
Y
contains "stages: steps" "$(cat out)" "44 steps at most, the first of 0.25 s, "
contains "stages: title" "$(cat out)" "Two stages: 96 particles"
# In plane stress waves run at sqrt(E / (1 - nu^2) / rho), nu = 1/3 of bonds, and along bars at sqrt(E / rho): 10 MPa and 2 t/m3, 200 GPa and 7.85 t/m3
for kind in 'correspondence 73' 'ordinary 73' 'bond-based 75'; do
  sed -e "s/{space: plane strain}/{space: plane stress, formulation: ${kind% *}}/" \
    -e 's/^materials: {/&s: {model: steel-bilinear, density: 7.85, Young modulus: 200 GPa, yield stress: 500 MPa, hardening ratio: 0.01}, /' \
    -e 's/^loads/bars: {bar: {points: [[0.05, 0.35], [1.15, 0.35]], diameter: 0.01, material: s}}\n&/' staged.yaml > flat.yaml
  [ "${kind% *}" = bond-based ] && sed -i 's/model: elastic,/model: elastic-1d,/; s/, Poisson ratio: 0.25}/}/' flat.yaml
  "$breccia" check flat.yaml > out 2> errors || fail "flat: $(cat errors)"
  contains "flat, $kind: waves" "$(cat out)" "  m: 2000 kg/m3, E 10 MPa, waves ${kind#* } m/s"
  contains "flat, $kind: bars" "$(cat out)" "  s: 7850 kg/m3, E 200 GPa, waves 5.05 km/s"
done
# Waves go through the body, not through the few heavy particles beside it: sqrt(12 MPa / 2 t/m3) and not sqrt(12 kPa / 2 t/m3)
printf 'x (m),y (m),volume (m3)\n-0.3,0.05,9\n-0.2,0.05,9\n-0.3,0.15,9\n-0.2,0.15,9\n' > beside.csv
sed -e 's/^materials: {/&water: {model: elastic, density: 2, Young modulus: 10, Poisson ratio: 0.25}, /' \
  -e 's/^body: {/&water: {material: water, lattice: square, spacing: 0.1, thickness: 0.2, file: beside.csv}, /' staged.yaml > beside.yaml
"$breccia" check beside.yaml > out 2> errors || fail "beside: $(cat errors)"
contains "waves of the body" "$(cat out)" "; a wave travels through in 20 ms" # 1.55 m
"$breccia" run staged.yaml --set 'title=Two stages' > out 2> errors || fail "run of stages: $(cat errors)"
s=staged/summary.json
end=$(figures $s time)
lines "stages: outcome" out <<Y
stage 'slow': steps 0 to 4, time 0 to 1 s
stage 'fast': steps 4 to 44, time 1 to $(printf %.6g "$end") s
load 'pull': traction, peak 1 kPa
load 'more': body force, peak 1 kN/m3
force in all on the body, the largest and at the end:
  load 'pull': [0.16, 0, 0] kN, [0.16, 0, 0] kN
  load 'more': [0, -0.024, 0] kN, [0, -0.024, 0] kN
  staged/solution.txt
Y
contains "stages: forces" "$(cat $s)" '"peak": 1, "unit": "kPa", "largest_force": [0.16, 0, 0], "force_at_end": [0.16, 0, 0]}'
lines "stages: summary" $s <<Y
  "title": "Two stages",
  "completed": true,
  "deck": "staged.yaml",
  "settings": ["title=Two stages"],
  "variables": {"size": "2"},
  "stages": [{"name": "slow", "steps": [0, 4], "times": [0, 1], "at_rest": true}, {"name": "fast", "steps": [4, 44], "times": [1, $end], "at_rest": false, "displacements_from_zero": true}],
  "first_broken_bond": null,
  "broken_bonds": 0,
Y
# what loads exert in the end, with moments about the origin: 0.16 kN at half the height of 0.8 m, and -1 kN/m3 on the upper row of 1.2 m x 0.1 m x 0.2 m
read -r x y z <<< "$(figures $s loads)"
near "stages: loads along x" "$x" 0.16 1e-9
near "stages: loads along y" "$y" -0.024 1e-9
equal "stages: loads along z" "$z" 0
near "stages: moment of loads" "$(figures $s 'moment of loads' | cut -d' ' -f3)" "$(awk 'BEGIN {print -0.16 * 0.4 - 0.024 * 0.6}')" 1e-3
grep -q '"left"' $s && fail "what is in motion is told as if it were to balance: $(cat $s)"

# ---- a stage that ends where the body is at rest, and one that does not ----
cat > calm.yaml <<'Y'
title: Calm
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 6]}}}}
peridynamics: {space: plane strain}
loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, traction: [1, 0]}]
solve:
  - {name: settle, explicit: {end time: 5, local damping: 0.8, rest: 1e-3}}
  - {name: go on, explicit: {steps: 5}}
pictures: []
Y
"$breccia" run calm.yaml > out 2> errors || fail "calm: $(cat errors)"
read -r first last <<< "$(sed -n "s/^stage 'settle': steps 0 to \([0-9]*\), time 0 to \([0-9.e-]*\) s, came to rest$/\1 \2/p" out)"
[ "${first:-0}" -gt 99 ] || fail "calm: no stage that came to rest in: $(cat out)"
grep -q "^stage 'go on': steps $first to $((first + 5)), time $last to [0-9.e-]* s$" out || fail "calm: the second stage in: $(cat out)"
contains "calm: summary" "$(cat calm/summary.json)" '"at_rest": true}, {"name": "go on", '
checks=$((checks + 2))

# ---- what loads come to: 1.2 m x 0.8 m x 0.2 m of 2 t/m3, and water that stands 0.5 m high ----
sed -e '/^  - /d' -e 's/^solve:/solve: {static: {}}/' -e "s/^loads:.*/loads:\n  - {on: {face: x-}, displacement: [0, 0]}\n  - {name: weight, gravity: [0, -9.81]}\n\
  - {name: slant, gravity: [3, -4]}\n  - {name: water, on: {face: x+}, water pressure: {surface: 0.5}}\n  - {name: suction, on: {face: y+}, pressure: -1}\n\
  - {name: shear, on: {face: y+}, traction: [-1, 0]}/" staged.yaml > forces.yaml
"$breccia" check forces.yaml > out 2> errors || fail "forces: $(cat errors)"
lines "forces" out <<'Y'
  load 'weight': a force in all of 3.77 kN along -y; acts in full from the start
  load 'slant': a force in all of 1.92 kN along [0.6, -0.8]; acts in full from the start
  load 'water': a force in all of 245 N along -x; acts in full from the start
  load 'suction': a force in all of 240 N along y; acts in full from the start
  load 'shear': a force in all of 240 N along -x; acts in full from the start
Y
# loads of one name are told apart by their stages
sed "s/name: more, on: {face: y+}, body force: \[0, -1\]/name: pull, on: {face: x+}, traction: [2, 0]/" staged.yaml > again.yaml
"$breccia" run again.yaml > out 2> errors || fail "again: $(cat errors)"
lines "again" out <<'Y'
load 'pull' of stage 'slow': traction, peak 1 kPa
load 'pull' of stage 'fast': traction, peak 2 kPa
Y

# ---- at rest: loads and reactions balance each other ----
sed '/name: fast/d' staged.yaml > rest.yaml
"$breccia" run rest.yaml > out 2> errors || fail "run at rest: $(cat errors)"
s=rest/summary.json
grep -q "^stage\|^at rest" out && [ "$(grep -c '^stage' out)" != 0 ] && fail "one stage is told as several: $(cat out)"
contains "at rest" "$(cat out)" "at rest: forces out of balance are "
lines "at rest: forces" out <<'Y'
force in all on the body, the largest and at the end:
  load in line 7: [-0.16, 0, 0] kN at time 0.5 s, [-0.16, 0, 0] kN
  load 'pull': [0.16, 0, 0] kN, [0.16, 0, 0] kN
Y
contains "at rest: supports" "$(cat out)" "supports and prescribed motions exert [-0.16, "
contains "at rest: loads" "$(cat out)" "kN, loads [0.16, 0, 0]; of all these forces "
read -r x y z <<< "$(figures $s reactions)"
near "at rest: reactions along x" "$x" -0.16 1e-8
near "at rest: moment of reactions" "$(figures $s 'moment of reactions' | cut -d' ' -f3)" 0.064 1e-3
checks=$((checks + 1))
awk -v left="$(figures $s left)" 'BEGIN {exit !(left != "" && left < 1e-8)}' || fail "at rest: left is $(figures $s left)"
grep -q '"stable_time_step"\|"stages"' $s && fail "a body at rest has a stable step, or one stage is listed: $(cat $s)"

# What converged by its measure is at rest by the same: a residual of 9e-4 is below 1e-3, where the sum of forces is 8e-3.
cat > long.yaml <<'Y'
title: Long
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: {particles: [120, 8]}}}}
peridynamics: {space: plane strain}
loads: [{on: {nearest: [0, 0]}, displacement: [0, 0]}, {on: {nearest: [12, 0]}, displacement: [free, 0]},
        {on: {nearest: [6, 0.8]}, displacement: [free, -0.01]}]
solve: {static: {increments: 1, method: relaxation, residual: 9e-4}}
pictures: []
Y
"$breccia" run long.yaml > out 2> errors || fail "long: $(cat errors)"
near "at rest: measure" "$(figures long/summary.json unbalanced)" \
  "$(sed -n 's/.*residual \([^,]*\), damping.*/\1/p' long/solution.txt | tail -1)" 0.01
grep -q '^at rest: ' out || fail "converged, but not at rest: $(cat out)"

# ---- increments whose ends descent by secants found ----
cat > cracks.yaml <<'Y'
title: A cantilever that cracks
materials: {m: {density: 2400 kg/m3, model: mazars, Young modulus: 30 GPa, Poisson ratio: 0.2, tensile strength: 3 MPa, fracture energy: 100 N/m}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [12, 6]}}}}
peridynamics: {space: plane stress}
loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]},
        {on: {face: x+, layers: 2}, displacement: [free, -0.5 mm], history: {ramp to: 1}}]
solve: {static: {end time: 0.6, increments: 6}}
Y
contains "time of a body that cracks" "$("$breccia" check cracks.yaml 2>&1)" "ten to a hundred times that where it cracks"
"$breccia" run cracks.yaml > out 2> errors || fail "a cantilever that cracks: $(cat errors)"
told=$(grep -o 'in [0-9]* of [0-9]* increments the body gave way' out errors | grep -o 'in [0-9]*' | cut -c4- | head -n 1)
contains "increments by secants" "$(cat cracks/summary.json)" "\"increments_by_secants\": ${told:-?},"
# The warning names the increments in which a body jumped, and the load that had its largest force as one began.
cat > peak.yaml <<'Y'
title: A strip that tears between two increments
units: {length: mm, force: N, time: s}
materials:
  c: &c {model: exponential-softening, density: 2.4e-9, Young modulus: 30000, tensile strength: 3, fracture energy: 0.06}
  w: {<<: *c, tensile strength: 2.7}
body:
  l: &b {material: c, lattice: square, spacing: 5, thickness: 100, shape: {box: {from: [0, 0], to: [95, 30]}}}
  m: {<<: *b, material: w, shape: {box: {from: [95, 0], to: [105, 30]}}}
  r: {<<: *b, shape: {box: {from: [105, 0], to: [200, 30]}}}
peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {nearest: [2.5, 17.5]}, displacement: [free, 0]}
  - {name: pull, on: {face: x+, layers: 3}, displacement: [0.05, free], history: {ramp to: 1}}
  - {name: side, on: {inside: {box: {from: [150, 0], to: [160, 30]}}}, spring: {stiffness: 1e-6}} # carries round-off
solve: {static: {increments: 10}}
pictures: []
Y
"$breccia" run peak.yaml > out 2> tears || fail "a strip that tears: $(cat tears)"
range=$(sed -n 's/.* increments the body gave way (\([0-9]*\) to \([0-9]*\)): .*/\1 \2/p' tears)
peak=$(sed -n "s/.*; the largest force of load 'pull' is that at the beginning of increment \([0-9]*\), .*/\1/p" tears)
[ "${peak:-0}" -ge "${range%% *}" ] && [ "$peak" -le "${range##* }" ] || fail "numbers of increments, the peak among them: $(cat tears)"
contains "what to do" "$(cat tears)" "compare with 'increments: 20'"
# 2.7 MPa of the weak strip are 0.016 mm of its 180 mm between grips, but for the share of bonds: the last words name the load then.
grep -q "^bonds: the first softened by time 0\.[234]* s (load 'pull': displacement 0\.01[0-9]* mm)$" out || fail "the first softened bond: $(cat out)"
grep -q "^first broken bond at step [0-9]*, time 0\.9[0-9]* s (load 'pull': displacement 0\.04[0-9]* mm), near " out || fail "the load of the first broken bond: $(cat out)"
grep -q increments_by_ $s && fail "an elastic body at rest gave way: $(cat $s)"
# Forces within the tolerance of equilibrium do work of either sign: a few nJ of 16 J are not worth a word.
awk -v d="$(figures cracks/summary.json damping)" -v e="$(figures cracks/summary.json external)" 'BEGIN {exit !(d * d < 1e-12 * e * e)}' ||
  fail "nothing to round: $(grep energy cracks/summary.json)"
grep -q '^energy:.* damping' out && fail "damping below zero: $(grep ^energy: out)"

# ---- a load that goes, and too few iterations ----
cat > taken.yaml <<'Y'
title: A load that is taken away
materials: {m: {model: j2, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2, yield stress: 1 MPa}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 3, 3]}}}}
loads: [{on: {face: x-, layers: 2}, displacement: [0, 0, 0]},
        {name: pull, on: {face: x+, layers: 1}, traction: [0, 0.2 MPa, 0], history: {table: [[0, 1], [2, 0.25]]}}]
solve: {static: {end time: 1, increments: 1, iterations: 1}}
Y
contains "a load that goes" "$("$breccia" check taken.yaml 2>&1)" "kN along y; goes from 1 to 0.25 of its value over 2 s"
"$breccia" run taken.yaml --quiet 2> errors && fail "one iteration for a body that yields"
contains "one iteration" "$(cat errors)" "1 iteration left "
contains "one iteration: what to do" "$(cat errors)" "out of balance: allow more 'iterations'"

# ---- a state each second step, one for a picture, and a folder of pictures that cannot be made ----
cat > block.yaml <<'Y'
title: Block
materials: {m: {model: elastic, density: 2400, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}
loads: [{name: pull, on: {face: x+}, body force: [1, 0, 0]}]
solve: {explicit: {steps: 60}}
results: {number: 30, fields: [displacement]}
pictures: [{field: displacement, at: [0, 1e9]}, {field: displacement, at: [0, 0.5 ms], name: moved}]
Y
"$breccia" run block.yaml > out 2> errors || fail "block: $(cat errors)"
# pictures of times behind the end are not made; several times of one name are told apart by them
equal "block: pictures" "$(sed -n 's,^ *block/pictures/,,p' out | tr '\n' ' ')" "displacement-0ms.png moved-0ms.png moved-$(awk -v d="$(figures block/summary.json time_step)" 'BEGIN {
  for (n = 0; d > 0 && n * d < 5e-4; ++n) continue
  printf "%.3g", 1e3 * n * d}')ms.png "
mkdir beside
: > beside/pictures
"$breccia" run block.yaml --output beside > out 2> errors
equal "no folder for pictures: status" $? 1
equal "no folder for pictures" "$(grep -v ^warning errors)" "beside/pictures: it is a file; expected a folder, or a name that is not there yet"
contains "no folder for pictures: the rest is there" "$(cat out)" "beside/results.vtkhdf"
ln -s nowhere leads
"$breccia" run block.yaml --output leads > out 2> errors
equal "a link that leads nowhere: status" $? 2
contains "a link that leads nowhere" "$(cat errors)" "leads: the folder cannot be made: it is a link that leads nowhere"

# ---- wrong wishes: one line each, and status 2 ----
# told WORDS ARGUMENTS
told() {
  local words=$1
  shift
  "$breccia" "$@" > out 2> errors
  equal "$*: status" $? 2
  equal "$*" "$(cat errors)" "$words"
  equal "$*: nothing else" "$(cat out)" ""
}
movie="breccia plot: --movie shows a field at all written steps and names its file itself: leave out"
told "breccia plot: --rate: '0' is not above 0 and up to 120 written steps a second" plot block --movie a.mp4 --rate 0
told "breccia plot: --rate: '121' is not above 0 and up to 120 written steps a second" plot block --movie a.mp4 --rate 121
told "breccia plot: --view: '3' should be two numbers with a colon between" plot block --view 3
told "breccia plot: --range: '1:2:3' should be two numbers with a colon between" plot block --range 1:2:3
told "breccia plot: --deformed: 'nan' is not a number" plot block --deformed nan
told "breccia plot: --time: '1 s' is not a number" plot block --time "1 s"
told "breccia: --size: '49' is not a whole number from 50 to 20000" plot block --size 49
told "breccia: --step: '-1' is not a whole number of at least 0" plot block --step=-1
told "breccia: --step: '7x' is not a whole number of at least 0" plot block --step 7x
told "step 7 was not written; these were: 0 ... 60 (32 states); --time takes the nearest" plot block --field displacement --step 7
told "breccia plot: give one result folder (several with --curve); see 'breccia plot --help'" plot block block
told "breccia plot: give one result folder (several with --curve); see 'breccia plot --help'" plot
told "$movie --output" plot block --movie a.mp4 --output b.mp4
told "$movie --time" plot block --movie a.mp4 --time 0
told "$movie --step" plot block --movie a.mp4 --step 0
told "breccia plot: --movie: a curve of histories has no use for it; leave it out" plot block --movie a.mp4 --energy
told "breccia plot: --movie: a curve of histories has no use for it; leave it out" plot block --movie a.mp4 --curve end.x:end.y
told "breccia study: give one deck; see 'breccia study --help'" study block.yaml block.yaml
told "breccia: --jobs: '0' is not a whole number of at least 1" study block.yaml --vary a=1,2 --jobs 0
told "breccia: --threads: '0' is not a whole number from 1 to 2147483647" study block.yaml --vary a=1,2 --threads 0
told "beside/pictures/a: the folder cannot be made: Not a directory" study block.yaml --vary solve.explicit.steps=1,2 --output beside/pictures/a
told "breccia check: give one deck; see 'breccia check --help'" check
told "breccia check: give one deck; see 'breccia check --help'" check block.yaml block.yaml
told "breccia modes: give one deck; see 'breccia modes --help'" modes
told "breccia: --count: '0' is not a whole number from 1 to 1000000" modes block.yaml --count 0
told "breccia spectrum: give a file, or two of which the first is held over the other; see 'breccia spectrum --help'" spectrum
told "breccia spectrum: 'c' is one argument too many" spectrum a b c
told "breccia spectrum: --below-column: there is no second file" spectrum a --below-column x
told "breccia spectrum: --damping: '5 %' is not a number" spectrum a --damping '5 %'
told "breccia spectrum: --smoothing: 'much' is not a number" spectrum a --smoothing much
told "breccia spectrum: --periods: '1' should be two numbers with a colon between" spectrum a --periods 1
told "breccia: --count: '0' is not a whole number from 1 to 1000000" spectrum a --count 0
told "no-such.AT2: No such file or directory" spectrum no-such.AT2
told "breccia spectrum: --time-step: '-1' is not a positive number of seconds" spectrum no-such.AT2 --time-step -1
told "breccia: --steps: '0' is not a whole number of at least 1" run block.yaml --steps 0
told "breccia: --threads: '99999999999999999999' is not a whole number from 1 to 2147483647" run block.yaml --threads 99999999999999999999
told "breccia run: --output needs a value; see 'breccia run --help'" run --output
curve="breccia material: a path of strains has no curve for"
told "$curve --picture: give a --test, or leave it out" material --model elastic --strain a.csv --picture a.png
told "$curve --against: give a --test, or leave it out" material --model elastic --strain a.csv --against a.csv
told "breccia material: --picture: 'a.gif' should end in .png, .svg or .pdf" material --model elastic --test uniaxial --picture a.gif
for words in "--model elastic" "--model elastic --strain a.csv --test uniaxial" "" "a.yaml b.yaml" "a.yaml --model elastic --test uniaxial"; do
  told "breccia material: give a file TEST.yaml, or --model with --strain or --test; see 'breccia material --help'" material $words
done
told "breccia: --cycles: '-1' is not a whole number from 0 to 1000000" material --model elastic --test uniaxial --cycles -1
for least in "steps 1" "elastic-rows 0"; do
  told "breccia: --${least% *}: '-1' is not a whole number of at least ${least#* }" material --model elastic --test uniaxial --${least% *} -1
done
told "breccia calibrate: give one file TEST.yaml, or 'concrete'; see 'breccia calibrate --help'" calibrate
told "breccia calibrate: --picture: 'a.gif' should end in .png, .svg or .pdf" calibrate a.yaml --picture a.gif
told "breccia schema: 'x' is one argument too many" schema x
told "breccia new: give the name of the deck to write, like plate.yaml" new
told "breccia new: give the name of the deck to write, like plate.yaml" new a b
told "usage: breccia serve --listen ADDRESS [options]" serve
told "usage: breccia serve --listen ADDRESS [options]" serve x --listen udp://127.0.0.1:0
contains "help of a verb" "$("$breccia" help plot)" "usage: breccia plot RESULT ... [options]"

# ---- threads of the cases of a study: the cores shared among the jobs, one at least, or as many as asked for ----
all=$(figures block/summary.json threads)
threads() {
  rm -rf shared
  "$breccia" study block.yaml --vary 'solve.explicit.steps=1,2,3' --result time --output shared "$@" > out 2> errors || fail "study $*: $(cat errors)"
  sed -n 's/.*"threads": \([0-9]*\),/\1/p' shared/*/summary.json | sort -u
}
equal "one job" "$(threads)" "$all"
equal "two jobs" "$(threads --jobs 2)" $((all > 2 ? all / 2 : 1))
equal "more jobs than cases" "$(threads --jobs 99)" $((all > 3 ? all / 3 : 1))
equal "threads asked for" "$(threads --jobs 2 --threads 3)" 3
# quietly: the table and no more
equal "a quiet study" "$("$breccia" study block.yaml --vary 'solve.explicit.steps=1,2,3' --result time --output shared --quiet)" "$(cat shared/table.txt)"

# ---- a fit: how far points lie from it, across the curve and as a share of their ranges ----
cat > fit.yaml <<'Y'
units: {length: mm, force: N, time: s}
material: {model: elastic-1d, density: 2e-9, Young modulus: 500}
test: {kind: uniaxial, strain: 0.005, steps: 50}
against: points.csv
fit: {Young modulus: {from: 500, to: 2000}}
Y
awk 'BEGIN {for (k = 1; k <= 40; ++k) print k * 1e-4 "," k * 0.1}' > points.csv
# points k / 39 along both axes and a line of slope s through zero: k (1 - s) / (39 sqrt(1 + s^2))
off() { # off SLOPE: the root of the mean square, and the most
  awk -v s="$1" 'BEGIN {for (k = 1; k <= 40; ++k) {d = k * (1 - s) / 39 / sqrt(1 + s * s); q += d * d / 40} printf "%.2f %.2f", 100 * sqrt(q), 100 * d}'
}
"$breccia" calibrate fit.yaml > out 2> errors || fail "calibrate: $(cat errors)"
read -r before most <<< "$(off 0.5)"
lines "a fit that is found" out <<< "40 points lie 0.00 % of their range from the curve (rms) and 0.00 % at most; with the file's values it was $before %."
contains "a fit that is found: starts" "$(cat out)" "9 of 9 starts came as near. "
contains "a fit that is found: value" "$(cat out)" "  Young modulus: 1000 N/mm2   (between 500 and 2000; "
sed -i 's/to: 2000/to: 800/' fit.yaml
"$breccia" calibrate fit.yaml > out 2> errors || fail "calibrate to an end: $(cat errors)"
read -r mean most <<< "$(off 0.8)"
lines "a fit at the end of its range" out <<< "40 points lie $mean % of their range from the curve (rms) and $most % at most; with the file's values it was $before %."
contains "a fit at the end of its range: value" "$(cat out)" "; it stands at the end of its range)"

# ---- help, completion and the manual page list the same options of each verb ----
"$breccia" completion > completion.sh
"$breccia" completion --man > page.1
for verb in run study check modes new plot spectrum models material calibrate serve schema completion; do
  options=$("$breccia" $verb --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p')
  equal "completion of $verb" "$(bash -c 'source completion.sh; COMP_WORDS=(breccia "$1" -); COMP_CWORD=2; _breccia; echo "${COMPREPLY[@]}"' _ $verb)" "--help $(echo $options)"
  equal "page of $verb" "$(awk -v v=$verb '$1 == ".SS" {on = $2 == v} on && $1 == ".B" {print $2}' page.1 | tr -d '\\')" "$options"
done

# ---- bonds: a line for each block ----
cat > bonds.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}
body:
  a: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}
  b: {material: m, spacing: 0.1, shape: {box: {from: [0.6, 0, 0], to: [1, 0.5, 0.4]}}}
peridynamics: {formulation: bond-based, calibration: uniaxial}
solve: {explicit: {steps: 2}}
Y
"$breccia" check bonds.yaml > out 2> errors || fail "bonds: $(cat errors)"
patch="a uniaxial patch shows 1.000 of the wanted modulus along the axes, [01][.][0-9]* along the diagonals of the faces, [01][.][0-9]* along those of space"
for block in a b; do equal "bonds of block $block" "$(grep -cx "$block: $patch" out)" 1; done

# ---- ground under stress: the upper three rows of five, at 10, 30 and 50 kPa downwards and half of that to the sides ----
cat > ground.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [3, 5]}}}}
peridynamics: {space: plane strain}
initial stress: [{on: {face: y+, layers: 3}, surface: 5, K0: 0.5, unit weight: 20}]
solve: {explicit: {steps: 2}}
Y
"$breccia" check ground.yaml > out 2> errors || fail "ground: $(cat errors)"
lines "ground" out <<< "9 particles begin under stress, mean -33.33 to -6.667 kPa"
# held by a wall at its left side: the same 9 particles, and not those that stand for the ground behind the wall
"$breccia" check ground.yaml --set 'loads=[{on: {face: x-}, support: {held: across}}]' > out 2> errors || fail "ground beside a wall: $(cat errors)"
lines "ground beside a wall" out <<< "9 particles begin under stress, mean -33.33 to -6.667 kPa"

# ---- one bond that is pulled until it breaks: 0.001 of 10 mm at 0.1 mm/ms are 0.1 ms; E s^2 / 2 of its 1000 mm3 are 15 N mm, less a step; masses of 2.4 g on
# 3e8 N/m vibrate by 5e5 / s, twice the inverse of which is the stable step ----
cat > pull.yaml <<'Y'
units: {length: mm, force: N, time: ms}
materials: {m: {model: elastic-1d, density: 2400 kg/m3, Young modulus: 30 GPa}}
body: {b: {material: m, lattice: line, area: 100, spacing: 10, shape: {box: {particles: [2, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D, horizon: 1.015 spacings, calibration: uniaxial}
failure: {critical stretch: 1e-3, near grips: break}
loads: [{on: {face: x-}, displacement: [0, free]}, {on: {face: x+}, velocity: [0.1, free]}]
solve: {explicit: {steps: 300, time step: 0.5 us}}
pictures: []
Y
"$breccia" run pull.yaml > out 2> errors || fail "pull: $(cat errors)"
contains "pull: steps" "$(cat out)" "300 steps of 0.0005 ms (0.13 of the stable 0.00399)"
contains "pull: end" "$(cat out)" "finished at step 300 of 300, time 0.15 ms; "
lines "pull" out <<'Y'
first broken bond at step 200, time 0.1 ms, near [10, 0, 0] mm; 1 of 1 bonds broken in all
Y
s=pull/summary.json
near "pull: fracture" "$(figures $s fracture)" 15 0.01
near "pull: stable step" "$(figures $s stable_time_step)" 0.004 0.003
near "pull: end of displacement" "$(figures $s displacement)" 0.015 1e-9
contains "pull: first broken bond" "$(cat $s)" '"first_broken_bond": {"step": 200, "time": 0.1, "particles": [0, 1], "at": [10, 0, 0], "cause": "limit", "criterion": "critical stretch", "material": "m", "quantity": "stretch", "value": 0.001, "limit": 0.001, "unit": ""}'
grep -q "cannot crush" out && fail "what was never pressed is told: $(cat out)"
# ---- a cone without dilation and tension cut-off in the deck: c cot(phi) of mean tension, 10 kPa / tan(30 deg) ----
cat > cone.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {m: {model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 10, friction angle: 30 deg}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 6]}}}}
peridynamics: {formulation: correspondence, space: plane strain}
loads: [{on: {face: y-}, support: {held: all}}, {gravity: [0, -1]}]
solve: {static: {increments: 1}}
Y
"$breccia" check cone.yaml > out 2> errors || fail "cone: $(cat errors)"
contains "cone" "$(cat out)" ", dilates by its friction (without 'dilation angle': confined ground bears too much), bears a mean tension of 17.3 kPa (without 'tension cut-off')"
sed 's/friction angle: 30 deg/&, dilation angle: 0, tension cut-off: 1/' cone.yaml > given.yaml
"$breccia" check given.yaml > out 2> errors || fail "cone: $(cat errors)"
grep -qE "dilates|bears a mean" out && fail "cone: what the deck gives is told: $(cat out)"
# ---- a bar of four bonds that is pressed by 0.04 mm: E times 0.001, and nothing crushes it ----
sed -e 's/elastic-1d/exponential-softening, tensile strength: 3 MPa, fracture energy: 100 N\/m/; s/particles: .2, 1./particles: [5, 1]/; /^failure/d' \
  -e 's/velocity: .0.1, free./displacement: [-0.04, free], history: {table: [[0, 0], [0.5, 1], [1, 0.5]]}/; s/^solve.*/solve: {static: {increments: 4}}/' \
  -e 's/^pictures/results: {every: 1}\n&/' pull.yaml > press.yaml
"$breccia" check press.yaml > out 2> errors || fail "press: $(cat errors)"
contains "press: check" "$(cat out)" ", no limit in compression"
"$breccia" run press.yaml > out 2> errors || fail "press: $(cat errors)"
contains "press" "$(cat out)" "material 'm' cannot crush ('exponential-softening' is elastic in compression): the largest compression is 30 MPa, at ["
s=press/summary.json
near "press: largest" "$(figures $s compression)" 30 2e-3
lines "press: forces" out <<'Y'
force in all on the body, the largest and at the end:
  load in line 5: [3000, 0, 0] N at time 0.5 ms, [1500, 0, 0] N
  load in line 5: [-3000, 0, 0] N at time 0.5 ms, [-1500, 0, 0] N
Y
# what stands at a rounding beside 0 is told as 0, one bond as one, and works below roundings of strains have no imbalance
"$breccia" run pull.yaml --set 'body.b.shape.box.first particle=[-5.00000000000001, 0]' --output around > out 2> errors || fail "around: $(cat errors)"
contains "around: first broken bond" "$(cat out)" "near [0, 0, 0] mm; "
contains "around: particles" "$(cat out)" ": 2 particles, 1 bond, 1 to 1 per particle"
sed 's/, failure.*//; /^failure/d; s/velocity: .0.1, free./force: [1e-30, 0]/; s/^solve.*/solve: {static: {}}/' pull.yaml > tiny.yaml
"$breccia" run tiny.yaml > out 2> errors || fail "tiny: $(cat errors)"
contains "tiny: energy" "$(cat out)" "fracture 0 J, less than roundings of strains hold: nothing balances them"
sed 's/solve:.*/solve: {static: {increments: 4}}/; /^failure/d; s/velocity: .0.1, free./displacement: [0.1, free]/' pull.yaml > hold.yaml
"$breccia" run hold.yaml > out 2> errors || fail "hold: $(cat errors)"
contains "hold: increments" "$(cat out)" "static, 4 increments up to time 1 ms, for 0 unknowns, "
near "hold: energy" "$(figures hold/summary.json stored)" 1500 1e-6

# ---- modes: what is told follows from their table, in whatever units the deck is ----
cat > short.yaml <<'Y'
units: {length: mm, force: N, time: ms}
materials: {m: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: m, lattice: square, spacing: 20, thickness: 20, shape: {box: {particles: [20, 4]}}}}
peridynamics: {space: plane stress}
loads: [{on: {face: x-}, displacement: [0, 0]}]
solve: {explicit: {end time: 1}}
Y
"$breccia" modes short.yaml --count 3 > out 2>&1 || fail "modes of a short bar: $(cat out)"
equal "modes: heading of the file" "$(head -1 short-modes/modes.csv)" "mode,frequency (Hz),mass share x,mass share y,mass share z"
equal "modes: heading" "$(head -1 out)" "mode   frequency      period   of the mass, along x     y"
# A cantilever of 39 cm between its support and its end, 8 cm deep, less what shear makes softer; its wave takes 4 times as long as to the end.
near "modes: bending" "$(awk -F, 'NR == 2 {print $2}' short-modes/modes.csv)" 285 0.15
near "modes: wave" "$(awk -F, 'NR == 4 {print $2}' short-modes/modes.csv)" 2267 0.03
awk -F, 'NR > 1 {f[NR - 1] = $2; x[NR - 1] = $3; y[NR - 1] = $4} function told(v,  u) {return sprintf("%.3g", v)}
  END {for (n = 1; n <= 3; ++n) {p = 1 / f[n]
    printf "%4d %11s %11s                 %3.0f %% %3.0f %%\n", n, f[n] < 1000 ? told(f[n]) " Hz" : told(f[n] / 1000) " kHz", p < 1e-3 ? told(1e6 * p) " µs" : told(1e3 * p) " ms", 100 * x[n], 100 * y[n]}
  printf "loads that are to leave the body at rest: over 5 to 10 of its first periods, %s ms to %s ms, or by '"'"'static'"'"'\n", told(5e3 / f[1]), told(1e4 / f[1])
  printf "to come to rest soonest by '"'"'explicit'"'"': damping: {ratio: 1, at: %.4g Hz}\n", f[1]
  printf "5 %% of critical damping by '"'"'implicit'"'"': Rayleigh damping: {ratio: 0.05, from: %.4g Hz, to: %.4g Hz}\n", f[1], f[3]
  printf "steps of '"'"'implicit'"'"' that follow all of these: %s µs\n", told(1e6 / (20 * f[3]))}' short-modes/modes.csv > told
lines "modes" out < told

# ---- layers that a support puts outside the body are in no picture of it: where nothing moves it looks as if it were held by its own particles ----
for held in "support: {held: all}" "displacement: [0, 0]"; do
  cat > held.yaml <<Y
title: Held
materials: {m: {model: elastic, density: 2400, Young modulus: 30 GPa, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 6]}}}}
peridynamics: {space: plane strain, formulation: ordinary}
loads: [{on: {face: x-}, $held}]
solve: {explicit: {steps: 2, time step: 1 us}}
results: {fields: [velocity]}
pictures: []
Y
  "$breccia" run held.yaml --quiet --output held 2> errors || fail "held: $(cat errors)"
  "$breccia" plot held --field velocity --output "${held%%:*}.svg" > out 2>&1 || fail "picture of the held body: $(cat out)"
done
checks=$((checks + 1))
cmp support.svg displacement.svg || fail "the picture of a body on a support shows what is outside the body"
finish

# The command as a person meets it: help, verbs, messages, exit statuses, files.
. "$(dirname "$0")/common.sh"
cd "$work"

"$breccia" --version > out; equal "version: status" $? 0
contains "version" "$(cat out)" "breccia 0."
# Commit, vector lanes, libraries, licence; by default nothing that puts the command under the GPL, neither told nor linked. libfyaml is the
# exception: before 0.9.1 a header of Linux is compiled into it, and the licence of both together is told in a line of its own.
for words in "commit: " "on this processor: " "HDF5 1." "libfyaml " "zlib " "licence: " "LICENSES.md"; do contains "version" "$(cat out)" "$words"; done
commit=$(git -C "$source" rev-parse --short=12 HEAD 2> /dev/null || echo unknown)
contains "version" "$(cat out)" "commit: $commit"
fyaml=$(sed -n 's/^libraries: .*libfyaml \([0-9.]*\),.*/\1/p' out)
from_linux=$(printf '%s\n0.9.1\n' "$fyaml" | sort -V | tail -1 | grep -vx "$fyaml" | wc -l)
equal "version: lines on the licence with libfyaml $fyaml" "$(grep -c "^licence with libfyaml $fyaml: GPL-2.0-only for the whole" out)" "$from_linux"
if grep -qs 'BRECCIA_SUITESPARSE:BOOL=ON' "$build/CMakeCache.txt"; then
  contains "version" "$(cat out)" "licence: GPL-2.0-or-later for this binary as a whole, because of CHOLMOD and UMFPACK"
else
  contains "version" "$(cat out)" "libraries: MUMPS "
  contains "version" "$(cat out)" "licence: BSD-3-Clause for this binary"
  for words in CHOLMOD UMFPACK SuiteSparse GPL; do
    checks=$((checks + 1))
    grep -v '^licence with libfyaml ' out | grep -q "$words" && fail "--version names $words"
  done
  ldd "$breccia" > linked 2> /dev/null || readelf -d "$breccia" > linked
  contains "linked libraries" "$(cat linked)" "mumps"
  checks=$((checks + 1))
  grep -E "lib(cholmod|umfpack|klu|spqr)" linked && fail "the command is linked with a library under the GPL"
fi
"$breccia" --help > out; equal "help: status" $? 0
for verb in run check modes new plot why spectrum models material calibrate schema completion; do
  contains "help" "$(cat out)" "  $verb "
  "$breccia" $verb --help > verb 2>&1; equal "$verb --help: status" $? 0
  contains "$verb --help" "$(cat verb)" "usage: breccia $verb"
  "$breccia" $verb --nonsense > verb 2>&1; equal "$verb --nonsense: status" $? 2
done
"$breccia" rnu 2> out; equal "rnu: status" $? 2
contains "rnu" "$(cat out)" "did you mean 'run'?"
"$breccia" > /dev/null 2>&1; equal "no verb: status" $? 2
"$breccia" wall.yaml > out 2>&1; equal "a deck for a verb: status" $? 2
contains "a deck for a verb" "$(cat out)" "a deck is run by 'breccia run wall.yaml'"
"$breccia" new no-folder/wall.yaml > out 2>&1; equal "new in no folder: status" $? 2
contains "new in no folder" "$(cat out)" "no-folder/wall.yaml: cannot be written: the folder does not exist"
"$breccia" run > /dev/null 2> out; equal "run without deck: status" $? 2
"$breccia" run a.yaml --steps many 2> out; equal "run --steps many: status" $? 2
contains "run --steps many" "$(cat out)" "--steps: 'many' is not a whole number"

# modes: a table, results that can be drawn, and what is wrong
cat > bar.yaml <<'END'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}
body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [80, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings, surface correction: energy}
loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]
solve: {static: {increments: 1}}
END
"$breccia" modes bar.yaml --count 2 > out 2>&1; equal "modes: status" $? 0
contains "modes" "$(cat out)" "damping: {ratio: 1, at: 45.4"
awk -F, 'NR == 2 {exit !($2 > 45 && $2 < 46)}' bar-modes/modes.csv || fail "modes: not a quarter of a wave: $(cat bar-modes/modes.csv)"
[ -s bar-modes/results.vtkhdf ] && [ -s bar-modes/pictures/mode-2.png ] || fail "modes: files are missing: $(ls -R bar-modes)"
"$breccia" plot bar-modes --field displacement --step 1 --output mode.png > out 2>&1; equal "plot of a mode: status" $? 0
"$breccia" check bar.yaml > out 2>&1; contains "check: frequency" "$(cat out)" "lowest frequency as the body is held: 45.4 Hz, a period of 22 ms"
sed 's/^solve.*/solve: {explicit: {steps: 10, damping: {ratio: 1, at: 45 Hz}}}/' bar.yaml > damped.yaml
"$breccia" check damped.yaml > out 2>&1; contains "check: damping" "$(cat out)" "loads over 110 ms to 220 ms leave it at rest; damping: {ratio: 1, at: 45.4"
sed 's/^loads.*//' damped.yaml > free.yaml
"$breccia" check free.yaml > out 2>&1; contains "check: free body" "$(cat out)" "as the body is held, apart from motion as a whole: 88.4 Hz"
sed 's/particles: \[80, 1\]/particles: [4001, 1]/' damped.yaml > long.yaml
"$breccia" check long.yaml > out 2>&1; contains "check: large body" "$(cat out)" "'breccia modes' finds it as the body is held"
# of what steps of an implicit run should be, a twentieth of the period; and of bodies whose frequency takes no longer than a second to find
sed 's/^solve.*/solve: {implicit: {end time: 1}}/' bar.yaml > slow.yaml
"$breccia" check slow.yaml > out 2>&1; contains "check: long steps" "$(cat out)" "lowest frequency as the body is held: 45.4 Hz, a period of 22 ms; steps of 1.1 ms follow it"
for horizon in 3.015 6.015; do
  cat > held-plate.yaml <<END
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}
body: {plate: {material: m, lattice: square, spacing: 0.05, thickness: 0.1, shape: {box: {particles: [40, 20]}}}}
peridynamics: {formulation: bond-based, space: plane stress, horizon: $horizon spacings}
loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]
solve: {static: {increments: 1}}
END
  "$breccia" check held-plate.yaml > out 2>&1
  equal "check: lowest frequency, horizon $horizon" "$(grep -c 'lowest frequency as the body is held' out)" "$(echo $horizon | grep -c '^3')"
done
"$breccia" modes bar.yaml --count 500 > out 2>&1; equal "modes: too many: status" $? 2
contains "modes: too many" "$(cat out)" "500 modes are too many for a body with 77 unknowns"

# spectrum: a record in g, the history of a run over it, files, and what is wrong
awk 'BEGIN {print "PEER\nHILL\nACCELERATION IN UNITS OF G\nNPTS= 2000, DT= .005 SEC"; for (k = 0; k < 2000; ++k) print 0.2 * sin(4 * 3.14159265 * k * 0.005)}' > hill.AT2
"$breccia" spectrum hill.AT2 > out 2>&1; equal "spectrum: status" $? 0
contains "spectrum: intensity" "$(cat out)" "largest acceleration              1.961 m/s2"
contains "spectrum: in g" "$(cat out)" "                                  0.2 g"
contains "spectrum: resonance" "$(cat out)" "oscillators with 5 % of critical damping: pseudo-acceleration 19.5"
for file in motion.csv response-spectrum.csv fourier.csv husid.png acceleration.png response-spectrum.png fourier.png; do
  [ -s hill-spectrum/$file ] || fail "spectrum: $file is missing: $(ls hill-spectrum)"
done
equal "spectrum: heading" "$(head -1 hill-spectrum/response-spectrum.csv)" "period (s),displacement (m),pseudo-velocity (m/s),pseudo-acceleration (m/s2),acceleration (m/s2)"
cat > shaken.yaml <<'END'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic-1d, Young modulus: 8e4, density: 2}}
body: {bar: {material: m, lattice: line, spacing: 1, area: 1, shape: {box: {particles: [20, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings, surface correction: energy}
selections: {base: {face: x-}, top: {face: x+}}
loads: [{on: base, acceleration: [9.80665, 0], history: {file: {name: hill.AT2}}}]
solve: {explicit: {end time: 10}}
watch: {base: {velocity of: base, every: 1}, top: {velocity of: top, every: 1}}
END
"$breccia" run shaken.yaml --quiet > out 2>&1; equal "spectrum: run" $? 0
"$breccia" spectrum shaken/base.csv hill.AT2 --column x --output same > out 2>&1; equal "spectrum of a run: status" $? 0
awk -F, '$1 > 1.5 && $1 < 2.5 {if ($4 < 0.97 || $4 > 1.03) exit 1; n = 1} END {exit !n}' same/fourier.csv || fail "spectrum: a base does not move as its record says: $(cat same/fourier.csv)"
"$breccia" spectrum shaken/top.csv shaken/base.csv --column x > out 2>&1; equal "spectrum of a column: status" $? 0
contains "spectrum of a column" "$(cat out)" "top over base: amplitudes "
[ -s shaken/top-spectrum/transfer.png ] || fail "spectrum: no picture of a transfer function"
equal "spectrum: heading of two" "$(head -1 shaken/top-spectrum/fourier.csv)" "frequency (Hz),amplitude (m/s),amplitude below (m/s),ratio"
# a file with several channels over itself: the channel that is chosen is that of both files, so that their ratio is 1
awk 'BEGIN {
  for (channel = 1; channel <= 2; ++channel) {
    print "Corrected acceleration  (Format v01.20 with 13 text lines)"; for (k = 0; k < 12; ++k) print "text"
    print "  10  Integer-header values follow on  1 lines, Format= (10I8)"; for (k = 0; k < 10; ++k) printf "%8d", -999; print ""
    print " 100  Real-header values follow on 17 lines, Format= (6F13.6)"
    for (k = 0; k < 100; ++k) printf "%13.6f%s", k == 61 ? 5 : -999, k % 6 == 5 || k == 99 ? "\n" : ""
    print "   1 Comment line(s) follow, each starting with a \"|\":\n| two channels"
    print " 800 acceleration pts, approx 4 secs, units=cm/sec2(04),Format=(8f10.5)"
    for (k = 0; k < 800; ++k) printf "%10.5f%s", 90 * sin(4 * channel * 3.14159265 * k * 0.005), k % 8 == 7 ? "\n" : ""
    print "End-of-data for channel"
  }}' > two.v2
"$breccia" spectrum two.v2 two.v2 --channel 2 --output channels > out 2>&1; equal "spectrum of a channel: status" $? 0
awk -F, 'NR > 1 && $4 != "" && tolower($4) != "nan" {if ($4 < 0.999 || $4 > 1.001) exit 1; n = 1} END {exit !n}' channels/fourier.csv || fail "spectrum: a channel over itself: $(cat out)"
"$breccia" spectrum hill.AT2 --periods 0.5:0.5 --damping 0.02 --count 1 --output one > out 2>&1; equal "spectrum: one period" $? 0
equal "spectrum: rows of one period" "$(wc -l < one/response-spectrum.csv)" 2

# new, check, run: the starter deck works as it comes
"$breccia" new plate.yaml > out; equal "new: status" $? 0
"$breccia" new plate.yaml 2> out; equal "new over a file: status" $? 2
contains "new over a file" "$(cat out)" "exists already"

# examples: listed with their titles, found by name, nothing written over
"$breccia" new --example > out; equal "new --example: status" $? 0
contains "new --example" "$(grep 'plate-with-crack/clay ' out)" "Plate of clay with an edge crack"
contains "new --example, laboratory" "$(sed -n '/laboratory/,$p' out)" "  materials/cap "
equal "new --example: examples" "$(grep -c '^  [a-z0-9-]*/' out)" "$(ls "$source"/examples/*/*.yaml | grep -cvE -- '-(none|one)\.yaml')"
"$breccia" new --example clay mine.yaml > out; equal "new --example clay: status" $? 0
cmp -s mine.yaml "$source/examples/plate-with-crack/clay.yaml" || fail "new --example clay writes another deck"
"$breccia" new --example cap cap.yaml > out; contains "new --example of a test" "$(cat out)" "'breccia material cap.yaml' runs it"
"$breccia" new other.yaml --example clay > out; equal "new DECK --example clay: status" $? 0
cmp -s mine.yaml other.yaml || fail "new DECK --example clay writes another deck"
"$breccia" new --example clay mine.yaml 2> out; equal "new --example over a file: status" $? 2
contains "new --example over a file" "$(cat out)" "mine.yaml: exists already"
"$breccia" new --example elastic a.yaml 2> out; equal "new --example of two: status" $? 2
contains "new --example of two" "$(cat out)" "give one of 'materials/elastic', 'plate-with-crack/elastic'"
"$breccia" new --example clya a.yaml 2> out; equal "new --example misspelt: status" $? 2
contains "new --example misspelt" "$(cat out)" "the nearest names are 'plate-with-crack/clay'"
"$breccia" new --example submarine a.yaml 2> out; equal "new --example unknown: status" $? 2
contains "new --example unknown" "$(cat out)" "'breccia new --example' lists them"
[ -e a.yaml ] && fail "new --example writes in spite of a wrong name"
contains "completion of examples" "$(bash -c 'source <("$1" completion); COMP_WORDS=(breccia new --example plate-with-crack/c); COMP_CWORD=3
  _breccia; echo "${COMPREPLY[@]}"' _ "$breccia")" "plate-with-crack/clay-opensees plate-with-crack/clay"
contains "manual page of new" "$("$breccia" completion --man | sed -n '/SS new/,/SS plot/p')" 'example'
"$breccia" check plate.yaml > out 2> errors; equal "check: status" $? 0
contains "check" "$(cat out)" "2500 particles"
sed -n 's/.*: 2500 particles, \([0-9]*\) bonds, 10 to 28 per particle (mean \([0-9.]*\)).*/\1 \2/p' out |
  awk '{d = 2 * $1 / 2500 - $2} END {exit !(NR == 1 && d * d < 0.0026)}' || fail "check: bonds are not counted in pairs: $(cat out)"
contains "check: body" "$(cat out)" "body: 500 mm x 500 mm, 60 kg; a wave travels through in 139 µs" # 0.5 m / sqrt(E / (1 - 0.2^2) / rho)
contains "check: material" "$(cat out)" "rock: 2400 kg/m3, E 30 GPa, waves 3.61 km/s, bonds break at a stretch of 0.0005 (elastically 15 MPa)"
contains "check: frequency" "$(cat out)" "about 3.54 kHz" # sqrt(E / rho) / (2 x 0.5 m)
contains "check: load" "$(cat out)" "load 'pull': acts in full from the start; a wave behind 100 mm/s carries 866 kPa" # rho c v
[ -s errors ] && fail "check complains: $(cat errors)"
[ -e plate ] && fail "check writes"
"$breccia" run plate.yaml --steps 100 > out 2> errors; equal "run: status" $? 0
contains "run" "$(cat out)" "finished at step 100 of"
[ -s errors ] && fail "run complains: $(cat errors)"
for file in results.vtkhdf results.xdmf summary.json checkpoint.h5 opening.csv grip.csv energy.csv pictures; do
  [ -e "plate/$file" ] || fail "run did not write $file"
done
ls plate | grep -q part && fail "half-written files are left: $(ls plate)"
# Pairwise hybrid bonds beside a notch keep no energy, whole as they are
cat > notch.yaml <<'Y'
title: Notched plate
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2}}
body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [20, 14]}}}}
cracks: [{cut: {line: [[0, 0.07], [0.06, 0.07]]}}]
peridynamics: {formulation: hybrid, form: variational, space: plane strain, horizon: 1.5 spacings}
loads:
  - {on: {face: y+, layers: 2}, velocity: [free, 0.1], history: {ramp to: 20e-6}}
  - {on: {face: y-, layers: 2}, velocity: [free, -0.1], history: {ramp to: 20e-6}}
solve: {explicit: {end time: 4e-4, stiffness damping: 4e-8}}
Y
"$breccia" run notch.yaml --output notch > notched 2>&1 || fail "notch: $(cat notched)"
grep -q "the imbalance is not that" notched && fail "run: variational bonds: $(cat notched)"
"$breccia" run notch.yaml --output notch --set peridynamics.form=pairwise > notched 2>&1 || fail "notch: $(cat notched)"
contains "run: pairwise bonds" "$(cat notched)" "the imbalance is not that of steps alone: hybrid bonds in 'form: pairwise' gain energy in free motion"
for key in particles bonds steps time_step stable_time_step wall_seconds ns_per_directed_bond_step first_broken_bond broken_bonds imbalance; do
  [ -n "$(json plate/summary.json $key)" ] || fail "summary.json lacks $key"
done
equal "summary: particles" "$(json plate/summary.json particles)" 2500
equal "summary: steps" "$(json plate/summary.json steps)" 100
contains "summary: units" "$(cat plate/summary.json)" '"units": {"times": "s", "positions and displacements": "m", "velocities": "m/s", "stresses": "kPa", "energies": "kN*m", "forces": "kN", "moments": "kN*m", "areas": "m2"}'
contains "summary: loads" "$(cat plate/summary.json)" '{"name": "pull", "line": 27, "kind": "velocity", "peak": 0.1, "unit": "m/s", "largest_force": ['
contains "run: loads" "$(cat out)" "load 'pull': velocity, peak 0.1 m/s"
equal "history: rows" "$(wc -l < plate/opening.csv)" 12
"$breccia" run plate.yaml --steps 3 --quiet --output "other folder/deep" > out 2>&1; equal "run --quiet: status" $? 0
[ -s out ] && fail "run --quiet prints: $(cat out)"
[ -e "other folder/deep/summary.json" ] || fail "--output is not obeyed"
# without --output: beside the deck, named after it, whatever points the names of folders have
mkdir -p parts.d/v1.2
for deck in parts.d/v1.2/plate parts.d/v1.2/plate.v2.yaml parts.d/v1.2/.plate; do
  cp plate.yaml $deck
  (cd parts.d && "$breccia" run ../$deck --steps 1 --quiet) || fail "run $deck"
done
equal "folders of results" "$(cd parts.d/v1.2 && find .. -name summary.json | sort)" "../v1.2/.plate.results/summary.json
../v1.2/plate.results/summary.json
../v1.2/plate.v2/summary.json"
touch file; "$breccia" run plate.yaml --steps 3 --output file/x 2> out > /dev/null; equal "output below a file: status" $? 2
"$breccia" run plate.yaml --steps 3 --output "" > out 2>&1; equal "output without a name: status" $? 2

# a load that waits and then jumps is told by its jump
cat > jump.yaml <<'J'
materials: {m: {model: elastic, density: 2400, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}
loads: [{on: {face: x+}, body force: [1000, 0, 0], history: {table: [[0, 0], [0.05, 0], [0.0501, 1]]}}]
solve: {explicit: {end time: 0.1}}
J
contains "jump" "$("$breccia" check jump.yaml)" "grows over 100 µs"

# a blow tells its kinetic energy, half the mass times the square of the speed; a run tells which loads have begun, and no size of supports
cat > blow.yaml <<'J'
materials: {m: {model: elastic, density: 2400, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}
loads: [{name: roll, on: {face: z-}, roller: [0, 0, 1]}, {name: weight, gravity: [0, 0, -9.81]}]
solve:
  - explicit: {steps: 4}
  - {explicit: {steps: 4}, loads: [{name: blow, on: {all: yes}, initial velocity: {translation: [3, 0, 4]}}]}
J
contains "blow" "$("$breccia" check blow.yaml)" "load 'blow': its particles begin with a kinetic energy of 4.8 kJ"
"$breccia" run blow.yaml --steps 2 > out || fail "run of the first stage"
contains "load of a later stage" "$(cat out)" "load 'blow': initial velocity, has not begun"
contains "load of a later stage, in the summary" "$(cat blow/summary.json)" '"kind": "initial velocity", "peak": 0,'
grep -qx "load 'roll': roller" out || fail "a support has a size: $(grep roll out)"
"$breccia" run blow.yaml > out || fail "run of both stages"
contains "load of this stage" "$(cat out)" "load 'blow': initial velocity, peak 5 m/s"

# a law is called as the deck calls it, also where its strains have limits
cat > limited.yaml <<'J'
materials: {m: {model: elastic-1d, density: 2400, Young modulus: 30 GPa, largest strain: 1e-3}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}
peridynamics: {formulation: bond-based}
solve: {explicit: {steps: 4}}
J
contains "name of a law with limits" "$("$breccia" check limited.yaml)" "m (elastic-1d)"

# what a load was before it ended is told of one that has ended; layers that supports put outside are no part of the body
cat > ended.yaml <<'J'
materials: {m: {model: j2, yield stress: 300 MPa, density: 2000, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}
peridynamics: {formulation: ordinary}
loads: [{on: {face: x-}, support: {held: all}}, {name: push, on: {face: x+}, force: [1 kN, 0, 0], history: {ramp to: 1 ms}}]
solve: [{explicit: {end time: 0.5 ms}}, {explicit: {end time: 1 ms}, without: [push]}]
J
"$breccia" run ended.yaml > out || fail "run without a load: $(cat out)"
contains "load that has ended" "$(cat out)" "load 'push': force, peak 500 N"
contains "size of a body with a support" "$(cat out)" "body: 1 m x 400 mm x 400 mm, 320 kg"

# a body is as heavy in millimetres as it is in metres
cat > small.yaml <<'Y'
units: {length: mm, force: N, time: s}
materials: {rock: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: rock, spacing: 10, shape: {box: {from: [0, 0, 0], to: [100, 50, 20]}}}}
solve: {explicit: {steps: 1}}
Y
contains "a body in millimetres" "$("$breccia" check small.yaml 2>&1)" "body: 100 mm x 50 mm x 20 mm, 240 g;"

# a burst writes the last good state and ends with status 1
sed '/^failure/d; s/end time: 2.0e-3 s/time step: 1e-4, steps: 5000/' plate.yaml > burst.yaml
"$breccia" run burst.yaml > out 2> errors; equal "unstable step: status" $? 2
"$breccia" run burst.yaml --force > out 2> errors; equal "burst: status" $? 1
contains "burst" "$(cat errors)" "step 3 (time 0.0003 s): the computation has blown up: particle "
contains "burst" "$(cat out)" "stopped by a failure"
contains "burst: energies" "$(cat out)" "energies, places and forces mean nothing after the computation has blown up"
# what has blown up is no result
"$breccia" plot burst --field displacement --step 3 > out 2> errors; equal "the state of a burst: status" $? 2
contains "the state of a burst" "$(cat errors)" "step 3 was not written; these were: 0"
if "$breccia" run plate.yaml --steps 20 --trap --output trapped > out 2> errors; then
  "$breccia" run plate.yaml --steps 20 --output untrapped > out 2>&1
  "$build/tests/compare_results" trapped/results.vtkhdf untrapped/results.vtkhdf > out || fail "traps change a run: $(cat out)"
else
  contains "traps" "$(cat errors)" "floating-point traps: there are none here; expected Linux on x86-64"
fi
[ -e burst/results.vtkhdf ] && [ -e burst/summary.json ] || fail "a burst leaves no results"
contains "burst: summary" "$(cat burst/summary.json)" '"blown_up": true,'
contains "burst: energies of the summary" "$(cat burst/summary.json)" '"energy": {"kinetic": null, '
contains "burst: summary" "$(cat burst/summary.json)" '"problem": "step '

# so does a body that is torn at rest, without advice for bodies that are nearly there
cat > torn.yaml <<'Y'
materials: {rock: {model: elastic-brittle, density: 2400 kg/m3, Young modulus: 30 GPa, tensile strength: 3 MPa}}
body: {b: {material: rock, lattice: square, spacing: 5 mm, thickness: 0.1 m, shape: {box: {particles: [24, 8]}}}}
peridynamics: {formulation: bond-based, space: plane stress}
failure: {near grips: hold}
loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {on: {face: x+}, traction: [9 MPa, 0], history: {ramp to: 1}}]
solve: {static: {}}
Y
"$breccia" run torn.yaml > out 2> errors; equal "torn at rest: status" $? 1
contains "torn at rest" "$(cat out)" "(at rest both are below 0.001): the run failed on the way"

# a picture of a time that the run does not reach
sed 's/at: \[6.2 ms, 6.4 ms\]/at: [6.2 ms, 64 ms]/' "$source/examples/block-with-hole/block.yaml" > late.yaml
"$breccia" check late.yaml > out 2> errors; equal "a late picture: status" $? 0
contains "a late picture" "$(cat errors)" "warning: late.yaml:72:21: the run ends at 0.008, before the picture at 0.064, which is not made"

# what is doubted before the run and what turns up in it are each told once
sed '/^failure/d; s/end time: 2.0e-3 s/end time: 2.0e-5 s, rest: 1e-9, damping: 1/; s/{field: damage}/{field: damage, at: [99]}/' plate.yaml > doubts.yaml
"$breccia" run doubts.yaml > out 2> errors; equal "doubts: status" $? 0
equal "a doubt before the run" "$(grep -c "before the picture at 99" errors)" 1
equal "a doubt of the run" "$(grep -c "ended at its end time" errors)" 1

# histories of a material at one particle
"$breccia" run "$source/examples/block-with-hole/block.yaml" --steps 20 --output block > out 2>&1; equal "block: status" $? 0
equal "history watched: heading" "$(head -1 block/p-history.csv)" "step,time (s),cap parameter (kPa)"
equal "history watched: the first cap" "$(sed -n 2p block/p-history.csv | cut -d, -f3 | cut -c1-8)" 8634.069

# material: one point against closed forms
printf 'strain xx,strain yy,strain zz,strain xy,strain yz,strain zx\n0.001,0,0,0,0,0\n0,0,0,0.002,0,0\n' > path.csv
"$breccia" material --model elastic --set "Young modulus=150 MPa" --set "Poisson ratio=0.25" --strain path.csv --output out.csv --tangent
equal "material: status" $? 0
equal "material: heading" "$(head -1 out.csv | cut -d, -f1-15)" "strain xx,strain yy,strain zz,strain xy,strain yz,strain zx,stress xx (Pa),stress yy (Pa),stress zz (Pa),stress xy (Pa),stress yz (Pa),stress zx (Pa),volumetric strain,tangent xx xx (Pa),tangent xx yy (Pa)"
equal "material: stress xx" "$(sed -n 2p out.csv | cut -d, -f7)" 180000
equal "material: stress xy" "$(sed -n 3p out.csv | cut -d, -f10)" 120000
equal "material: tangent xx xx" "$(sed -n 2p out.csv | cut -d, -f14)" 180000000
"$breccia" material --model elastic --set "Young modulus=150" --set "Poisson ratio=0.25" --units "mm, N, s" --strain path.csv > out.csv
equal "material in other units: heading" "$(head -1 out.csv | cut -d, -f7)" "stress xx (N/mm2)"
awk -F, 'NR == 2 {exit !($7 > 0.18 * (1 - 1e-12) && $7 < 0.18 * (1 + 1e-12))}' out.csv || fail "material in other units: $(sed -n 2p out.csv)"
"$breccia" material --model elastic-1d --set "Young modulus=2 MPa" --strain path.csv --tangent > bar.csv
equal "material of one strain" "$(cat bar.csv)" "strain xx,stress xx (Pa),tangent xx xx (Pa)
0.001,2000,2000000
0,0,2000000"
"$breccia" material --model elastic --set "Young=1" --strain path.csv 2> out; equal "material, wrong key: status" $? 2
contains "material, wrong key" "$(cat out)" "--set Young=1: did you mean 'Young modulus'? expected KEY=VALUE with one of the keys 'Young modulus'"
"$breccia" material --model Elastic --set E=1 --strain path.csv 2> out; equal "material, wrong model: status" $? 2
contains "material, wrong model" "$(cat out)" "there is no model 'Elastic'; did you mean 'elastic'?"
"$breccia" material --model multi-yield-j2 --strain path.csv 2> out; equal "material, nothing set: status" $? 2
contains "material, nothing set" "$(cat out)" "missing --set 'shear modulus=...'"
contains "material, nothing set: all at once" "$(cat out)" "missing --set 'bulk modulus=...'"
printf 'units: \000\n' > zero.yaml
"$breccia" material zero.yaml 2> out; equal "test with a zero byte: status" $? 2
contains "test with a zero byte" "$(cat out)" "zero.yaml:1:1: is not text"
clay='--model multi-yield-j2 --set shear~modulus=60~MPa --set bulk~modulus=100~MPa --set octahedral~strength=30~kPa --units m,kN,s'
words() { echo "$1" | sed 's/ /\n/g' | tr '~' ' '; }
mapfile -t clay < <(words "$clay")
"$breccia" material "${clay[@]}" --test uniaxial --to 0.3 --steps 3000 --output uniaxial.csv > out; equal "uniaxial test: status" $? 0
equal "uniaxial test: strength 3 tau / sqrt 2" "$(tail -1 uniaxial.csv | cut -d, -f7 | cut -c1-6)" 63.639
"$breccia" material "${clay[@]}" --test "simple shear" --to 0.002 --cycles 2 --steps 50 > shear.csv; equal "shear test: rows" "$(wc -l < shear.csv)" 202
awk -F, 'NR > 1 {print $4 "," $10}' shear.csv > measured.csv
"$breccia" material "${clay[@]}" --test "undrained shear" --to 0.002 --cycles 2 --steps 50 --against measured.csv --picture shear.png --output again.csv > out
contains "measured points" "$(cat out)" "201 measured points (shear strain, shear stress in kPa) lie 0.00 % of their range from the curve (rms)"
[ -s shear.png ] || fail "material: no picture"
"$breccia" material "${clay[@]}" --test uniaxial --to 0.001 --picture shear.png > out; equal "material with a picture says only its name" "$(cat out)" shear.png
"$breccia" material "${clay[@]}" --test shear 2> out; equal "unknown test: status" $? 2
contains "unknown test" "$(cat out)" "the tests are 'uniaxial', 'triaxial'"
contains "test without its strain" "$(cat out)" "--test needs --to STRAIN"
"$breccia" material --model elastic-1d --set "Young modulus=1" --test triaxial --to 1 2> out; equal "triaxial test of a fibre" $? 2
"$breccia" material "${clay[@]}" 2> out; equal "material without a test" $? 2
cat > test.yaml <<END
title: Consolidated and sheared
units: {length: m, force: kN, time: s}
material: {model: drucker-prager, density: 2 t/m3, Young modulus: 50 MPa, Poisson ratio: 0.3, cohesion: 20 kPa, friction angle: 30 deg}
stages:
  - {stress xx: -50, stress yy: -50, stress zz: -50, steps: 10}
  - {strain xx: -0.02, stress yy: -50, stress zz: -50}
END
"$breccia" material test.yaml > stages.csv; equal "stages: status" $? 0
# a cone that touches the compressive edges: 3 s3 + 2 sqrt(3) c
equal "stages: strength" "$(tail -1 stages.csv | cut -d, -f7 | cut -c1-8)" -219.282
sed -i 's/strain xx: -0.02/stress xx: -400/' test.yaml
"$breccia" material test.yaml > stages.csv 2> out; equal "stress beyond the strength: status" $? 1
contains "stress beyond the strength" "$(cat out)" "stage 2, step 49 of 100: the stresses asked for cannot be reached"
sed -i 's/stages:/stage:/' test.yaml
"$breccia" material test.yaml 2> out; equal "test with a wrong key: status" $? 2
contains "test with a wrong key" "$(cat out)" "test.yaml:4:1: element test: unknown key 'stage'; did you mean 'stages'?"
"$breccia" material "${clay[@]}" --test "simple shear" --to 0.01 --steps 25 | awk -F, 'NR > 1 {print $4 "," $10}' > measured.csv
cat > fit.yaml <<END
units: {length: m, force: kN, time: s}
material: {model: multi-yield-j2, density: 2 t/m3, shear modulus: 30 MPa, bulk modulus: 100 MPa, octahedral strength: 50}
test: {kind: simple shear, strain: 0.01, steps: 100}
against: measured.csv
fit: {shear modulus: {from: 1e4, to: 2e5}, octahedral strength: {from: 10, to: 100}, bulk modulus: {from: 5e4, to: 2e5}}
END
"$breccia" calibrate fit.yaml --picture fit.png > out; equal "calibrate: status" $? 0
[ -s fit.png ] || fail "calibrate: no picture"
fitted() { sed -n "s/^  $1: \([0-9.e+]*\) .*/\1/p" out; }
awk -v g="$(fitted "shear modulus")" -v t="$(fitted "octahedral strength")" \
  'BEGIN {exit !(g > 59700 && g < 60300 && t > 29.9 && t < 30.1)}' || fail "calibrate does not find 60 MPa and 30 kPa: $(cat out)"
contains "calibrate: what does not matter" "$(grep "bulk modulus" out)" "these points do not tell it"
sed -i 's/fit: {shear modulus/fit: {modulus/' fit.yaml
"$breccia" calibrate fit.yaml 2> out; equal "calibrate with a wrong name: status" $? 2
contains "calibrate with a wrong name" "$(cat out)" "fit.yaml:5:7: fit: multi-yield-j2 has no parameter 'modulus'"
sed -i '/^fit:/d' fit.yaml
"$breccia" calibrate fit.yaml 2> out; contains "calibrate nothing" "$(cat out)" "nothing to calibrate"
"$breccia" models > out; contains "models" "$(cat out)" "multi-yield-j2"
contains "models" "$(cat out)" "octahedral strength"
"$breccia" models elastic > out; contains "models elastic" "$(cat out)" "Poisson ratio"

# completion is valid shell, the page is troff
"$breccia" completion > completion.sh && bash -n completion.sh || fail "completion is not shell"
bash -c 'source completion.sh; COMP_WORDS=(breccia ru); COMP_CWORD=1; _breccia; [ "${COMPREPLY[0]}" = run ]' || fail "completion does not complete"
"$breccia" completion --man > page.1; contains "page" "$(head -1 page.1)" ".TH BRECCIA 1"
finish

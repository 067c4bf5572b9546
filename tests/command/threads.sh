# The same bits with one thread and with several, whatever the threads work on: formulations, breaking, contact, loads, laws in servers,
# pictures. Under the thread sanitizer (make tsan) each of these runs is also watched for races.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

cat > correspondence.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  clay: {model: multi-yield-j2, density: 1.5, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30 kPa}
body: {block: {material: clay, spacing: 0.1, shape: {box: {particles: [14, 8, 4]}}}}
cracks: [{cut: {line: [[0.65, -1], [0.65, 0.35]]}}]
peridynamics: {formulation: correspondence, strain: green-lagrange, zero-energy control: {silling: 0.1}}
failure: {critical stretch: 0.004}
loads:
  - {on: {face: x-, layers: 3}, traction: [-120, 0, 0], history: {ramp to: 5 ms}}
  - {on: {face: x+, layers: 3}, velocity: [0.5, 0, 0]}
solve: {explicit: {steps: 120, damping: 20 1/s}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 50}
pictures: [{field: damage}, {field: octahedral shear stress, deformed: 5}]
Y
cat > ordinary.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  steel: {model: j2, density: 8, Young modulus: 200 GPa, Poisson ratio: 0.3, yield stress: 300 MPa}
body: {plate: {material: steel, lattice: hexagonal, thickness: 0.1, spacing: 0.1, shape: {box: {from: [0, 0], to: [2.4, 1.6]}}}}
cracks: [{cut: {line: [[1.2, -1], [1.2, 0.5]]}}]
peridynamics: {formulation: ordinary, space: plane strain}
failure: {criterion: critical bond energy, fracture energy: 60 kN/m}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, free]}
  - {on: {face: y-, layers: 1}, roller: [0, 1]}
  - {on: {face: x+, layers: 2}, tie: {directions: x}}
  - {on: {face: x+, layers: 2}, pressure: -2 GPa, history: {ramp to: 0.2 ms}}
solve: {explicit: {steps: 250}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 100}
pictures: [{field: damage}]
Y
{
  echo x,y,z,volume
  for k in 0 1 2 3; do for j in 0 1 2 3; do for i in 0 1 2 3 4 5 6 7 8 9; do
    echo "$i.0$(((i * 7 + j * 3 + k) % 10)),$j.0$(((i * 3 + j * 5 + k * 7) % 10)),$k.0$(((i + j * 9 + k) % 10)),1"
  done; done; done
} > grains.csv
cat > bonds.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 30 kN/m}
  s: {model: elastic-1d, density: 2.4, Young modulus: 30 GPa}
body:
  grains: {material: c, spacing: 1, file: grains.csv}
  more: {material: s, spacing: 1, shape: {box: {from: [9.6, -0.5, -0.5], to: [14.6, 3.5, 3.5]}}}
  hammer: {material: s, spacing: 1, shape: {box: {from: [6, 4.2, 0], to: [8, 6.2, 2]}}}
peridynamics: {formulation: bond-based, calibration: continuum}
contact: {friction: 0.3}
loads:
  - {on: {face: x-, layers: 2}, velocity: [0, 0, 0]}
  - {on: {block: more}, velocity: [10, 0, 0], history: {ramp to: 0.002}}
  - {on: {block: hammer}, initial velocity: {translation: [0, -80, 0]}}
  - {on: {block: hammer}, spring: {to: {block: grains}, stiffness: 5 MN/m}}
solve: {explicit: {steps: 200}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 100, fields: [displacement, damage, bond damage]}
pictures: [{field: damage}]
Y
cat > regions.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m}
  s: {model: viscoelastic, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.25, relaxing share: 0.5, relaxation time: 1 ms}
body:
  left: {material: c, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}
  right: {material: s, spacing: 10 mm, lattice: square, thickness: 0.1, shape: {box: {from: [0.2, 0], to: [0.4, 0.1]}}}
peridynamics: {formulation: ordinary, space: plane stress, regions: {fibres: {blocks: [left], formulation: bond-based}}}
failure: {critical stretch: 3e-4}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {face: x+, layers: 3}, velocity: [0.5, free]}
solve: {explicit: {steps: 250}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 100}
pictures: []
Y
# points in space on bonds, of two materials, some of which yield
cat > hybrid.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  hard: {model: j2, density: 2, Young modulus: 40 MPa, Poisson ratio: 0.3, yield stress: 80 kPa, hardening modulus: 5 MPa}
  soft: {model: elastic, density: 2, Young modulus: 30 MPa, Poisson ratio: 0.2}
body:
  left: {material: hard, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [0.7, 0.6, 0.3]}}}
  right: {material: soft, spacing: 0.1, shape: {box: {from: [0.7, 0, 0], to: [1.4, 0.6, 0.3]}}}
peridynamics: {formulation: hybrid, horizon: 1.5 spacings}
failure: {critical stretch: 0.004, near grips: hold}
loads:
  - {on: {face: x-, layers: 2}, velocity: [-0.6, 0, 0], history: {ramp to: 1 ms}}
  - {on: {face: x+, layers: 2}, velocity: [0.6, 0, 0], history: {ramp to: 1 ms}}
solve: {explicit: {steps: 120}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 50}
pictures: []
Y
cp "$source/tests/command/decks/bars.yaml" .
# comes to its strength at rest, flows on in motion, and is at rest again
cat > handed.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening modulus: 0}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 5, 5]}}}}
failure: {critical stretch: 0.003, near grips: hold}
peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}
loads:
  - {on: {face: x-}, support: {held: across}}
  - {on: {face: y-}, support: {held: across}}
  - {on: {face: z-}, support: {held: across}}
  - {name: pull, on: {face: x+, layers: 1}, traction: [12, 0, 0], history: {ramp to: 1}}
solve:
  - {static: {increments: 4, no equilibrium: next stage}}
  - {name: flow, loads: [{name: pull, on: {face: x+, layers: 1}, traction: [11, 0, 0], history: {table: [[0, 1], [0.2, 1], [0.3, 0.4545454545]]}}],
     explicit: {steps: 100, local damping: 0.8}}
  - {loads: [{name: pull, on: {face: x+, layers: 1}, traction: [9, 0, 0], history: {table: [[0, 0.5555555556], [1, 1]]}}], static: {increments: 2}}
watch: {energy: {energy: yes, every: 1}}
results: {number: 3, precision: double}
pictures: []
Y
# begins under stress, which hardens a part of it
cat > stressed.yaml <<'Y'
units: {length: m, force: kN, time: s}
materials:
  hard: {model: j2, density: 2, Young modulus: 40 MPa, Poisson ratio: 0.3, yield stress: 80 kPa, hardening modulus: 5 MPa}
body: {block: {material: hard, spacing: 0.1, shape: {box: {particles: [14, 7, 4]}}}}
peridynamics: {formulation: correspondence}
failure: {critical stretch: 0.004}
initial stress:
  - {on: {inside: {box: {from: [0, 0, 0], to: [0.7, 0.7, 0.4]}}}, stress: [-60, 10, -20, 25, 0, 5]}
  - {on: {inside: {box: {from: [0.7, 0, 0], to: [1.4, 0.7, 0.4]}}}, stress: [-120, 10, 10, 0, 0, 0]}
loads:
  - {on: {face: x-, layers: 3}, velocity: [-2, 0, 0]}
  - {on: {face: x+, layers: 3}, velocity: [2, 0, 0]}
solve: {explicit: {steps: 120}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 50}
pictures: []
Y
cat > served.yaml <<Y
units: {length: m, force: kN, time: s}
materials:
  clay: {remote: multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral strength=30, density: 1.5,
         server: ['unix:$work/one', 'unix:$work/two']}
body: {block: {material: clay, spacing: 0.1, shape: {box: {particles: [12, 6, 3]}}}}
peridynamics: {formulation: correspondence, zero-energy control: {silling: 0.1}}
failure: {critical stretch: 0.004}
loads:
  - {on: {face: x-, layers: 3}, velocity: [-0.5, 0, 0]}
  - {on: {face: x+, layers: 3}, velocity: [0.5, 0, 0]}
solve: {explicit: {steps: 60}}
watch: {energy: {energy: yes, every: 10}}
results: {number: 3, precision: double, checkpoint steps: 25}
pictures: []
Y

run() { # run DECK THREADS
  "$breccia" run "$1.yaml" --threads "$2" --output "$1-$2" > out 2>&1 || fail "$1 with $2 threads: $(cat out)"
}
for server in one two; do
  "$breccia" serve --listen "unix:$work/$server" > $server.out 2>&1 &
  servers="${servers:-} $!"
  wait_for $! grep -q listening $server.out || fail "$server: $(cat $server.out)"
done
# Under the sanitizers a run on several threads is enough: that its bits are those of one thread is seen without them.
compared=1 several=3
[ -n "${BRECCIA_WHOLE:-}" ] && several="2 3"
[ -n "${BRECCIA_SANITIZED:-}" ] && compared= several=2
for deck in correspondence ordinary bonds regions hybrid bars handed stressed served; do
  for threads in $compared $several; do run $deck $threads; done
  [ "$(json "$deck-${several##* }/summary.json" broken_bonds)" -gt 0 ] || fail "$deck: no bond breaks, the test is too tame"
  checks=$((checks + 1))
  [ -n "$compared" ] || continue
  for threads in $several; do
    for file in results.vtkhdf checkpoint.h5; do
      [ $deck-$file = served-checkpoint.h5 ] && continue # it names sessions, which are another each time
      "$build/tests/compare_results" $deck-1/$file $deck-$threads/$file > out || fail "$deck with $threads threads: $file differs: $(cat out)"
    done
    cmp -s $deck-1/energy.csv $deck-$threads/energy.csv || fail "$deck with $threads threads: energies differ"
    checks=$((checks + 3))
  done
done
for server in $servers; do
  kill "$server"
  wait "$server"; equal "server: status" $? 0
done
finish

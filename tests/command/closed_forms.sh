# The examples whose answers are known otherwise, on coarse lattices.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

run() { # run DECK [options]
  "$breccia" run "$source/examples/$1.yaml" --quiet --output "$work/$(basename "$1")" "${@:2}" > out 2>&1 || fail "$1: $(cat out)"
}
# value FOLDER/WATCH COLUMN: the last one of a history
value() { tail -1 "$work/$1.csv" | cut -d, -f"$2"; }
# near WHAT FOUND EXPECTED SHARE: within a share of what is expected
near() {
  checks=$((checks + 1))
  awk -v a="$2" -v b="$3" -v s="$4" 'BEGIN {d = a / b - 1; exit !(a != "" && d <= s && d >= -s)}' || fail "$1 is $2, expected $3 within $4 of it"
}
exact() { awk "BEGIN {printf \"%.10g\", $1}"; }

# weight (H y - y^2 / 2) / (K + 4 G / 3) at the uppermost particles, and weight (H - y) at the lowest
run gravity-column/column
near "settlement of the column" "$(value column/top 4)" "$(exact "-19.62 * (10 * 9.875 - 9.875 ^ 2 / 2) / 180e3")" 0.002
near "stress under the column" "$(value column/base 10)" "$(exact "-19.62 * 9.875")" 0.005

# Lamé: u = (1 + nu) / E p a^2 / (b^2 - a^2) ((1 - 2 nu) r + b^2 / r), a particle above the wall
run pressurised-ring/ring --set "variables.dx=50 mm"
near "opening of the ring" "$(value ring/wall 4)" "$(exact "1.25 / 10e6 * 1000 / 3 * (0.5 * 1.025 + 4 / 1.025)")" 0.025

# Kirsch: u E / (sigma a) at r, in plane stress: ((1 + nu) / 2) (r ((k - 1) / 2 + 1) + (2 + k) / r - 1 / r^3), k = (3 - nu) / (1 + nu)
run plate-with-hole/plate --set "variables.dx=10 mm"
near "widening of the hole" "$(value plate/side 3)" "$(exact "1000 * 0.1 / 210e6 * 0.65 * (1.05 * (1 + (2.7 / 1.3 - 1) / 2) + (2 + 2.7 / 1.3) / 1.05 - 1.05 ^ -3)")" 0.025
near "stress above the hole" "$(value plate/edge 9)" "$(exact "1000 * (1 + 0.5 / 1.05 ^ 2 + 1.5 / 1.05 ^ 4)")" 0.08

# Kirsch and Lamé by ordinary families at two spacings. The stress of the first particle beside the hole is a mean over
# half a family, and less than Kirsch's stress there. The stress of force states alone would be 12 % too large there at
# 5 mm, and 20 % too large at the wall of the ring.
for dx in 10 5; do
  sed 's/formulation: correspondence, space: plane stress, strain: small/formulation: ordinary, space: plane stress/' \
    "$source/examples/plate-with-hole/plate.yaml" > hole.yaml
  "$breccia" run hole.yaml --quiet --output "$work/hole-$dx" --set "variables.dx=$dx mm" > out 2>&1 || fail "hole, $dx mm: $(cat out)"
  r=$(exact "1 + $dx / 200")
  near "widening of the hole, ordinary, $dx mm" "$(value "hole-$dx/side" 3)" \
    "$(exact "1000 * 0.1 / 210e6 * 0.65 * ($r * (1 + (2.7 / 1.3 - 1) / 2) + (2 + 2.7 / 1.3) / $r - $r ^ -3)")" 0.02
  near "stress above the hole, ordinary, $dx mm" "$(value "hole-$dx/edge" 9)" \
    "$(exact "1000 * (1 + 0.5 / $r ^ 2 + 1.5 / $r ^ 4)")" "$(exact "0.03 + 0.01 * $dx")"
done
for dx in 50 25; do
  sed -e 's/formulation: correspondence, space: plane strain, strain: small/formulation: ordinary, space: plane strain/' \
    -e 's/displacement of: {nearest: \(.*\)}, every: 1}/displacement of: {nearest: \1}, every: 1}\n  hoop: {stress and strain of: {nearest: \1}, every: 1}/' \
    "$source/examples/pressurised-ring/ring.yaml" > wall.yaml
  "$breccia" run wall.yaml --quiet --output "$work/wall-$dx" --set "variables.dx=$dx mm" > out 2>&1 || fail "ring, $dx mm: $(cat out)"
  r=$(exact "1 + $dx / 2000")
  near "opening of the ring, ordinary, $dx mm" "$(value "wall-$dx/wall" 4)" "$(exact "1.25 / 10e6 * 1000 / 3 * (0.5 * $r + 4 / $r)")" 0.025
  near "hoop stress of the ring, ordinary, $dx mm" "$(value "wall-$dx/hoop" 9)" "$(exact "1000 / 3 * (1 + 4 / $r ^ 2)")" 0.05
done

# Timoshenko and Goodier: P L^3 / (3 E I) + (4 + 5 nu) P h^2 L / (24 E I), and P (L / 2) (h / 4) / I; last column's centres half a spacing before the end
for form in variational pairwise; do
  run cantilever/cantilever --set "peridynamics.form=$form" --set "variables.layers=1.5"
  near "deflection of the cantilever, $form" "$(awk "BEGIN {printf \"%.10g\", 2 * $(value cantilever/end 4) - $(value cantilever/last-two 4)}")" -0.01708333 0.02
  near "stress in the cantilever, $form" "$(value cantilever/quarter 9)" 18750 0.02
  rm -r "$work/cantilever"
done

# Clay sheared to 0.9 of its strength: the corner of its backbone, and at the top, as the traction is spread as by the bonds cut off
run soil-column-static/column --set "variables.dx=0.5 m"
strain=$(exact "sqrt(1.5) * (3 / 5970 * 27 / (60e3 * 3 / 5970 - 27) - (3 / 5970 * 1.5 / (60e3 * 3 / 5970 - 1.5) - 1.5 / 60e3))")
near "strain of the column of clay" "$(value column/middle 6)" "$strain" 1e-6
near "stress in the column of clay" "$(value column/middle 12)" "$(exact "0.9 * sqrt(1.5) * 30")" 1e-6
near "top of the column of clay" "$(value column/top 3)" "$(exact "9.75 * $strain")" 1e-6

# The same clay shaken by a pulse, on a coarse lattice: OpenSees comes to 33.71 mm (80 stdBrick, PressureIndependMultiYield; its README.md)
run soil-column-seismic/column --set "variables.dx=1 m" --set "variables.duration=1.2 s" --set "variables.step=10 ms"
near "displacement of the shaken column" "$(tail -n +2 column/top.csv | cut -d, -f3 | sed 's/^-//' | sort -gr | head -1)" 0.0337 0.02

# The opening to which rest.yaml comes by damping, in 6000 steps
run plate-with-crack/static
near "opening of the crack" "$(value static/mouth 4)" 0.0033157288 1e-6
# The same plate by hybrid bonds: finite elements 3.343 mm; of fibres, with their E over 0.925172, 3.292 mm (orthotropic elements)
run plate-with-crack-1d-3d/rest
near "opening of the crack, laws in space" "$(value rest/mouth 4)" 0.003343 0.02
sed 's/model: elastic, \(.*\)Young modulus: 150 MPa, Poisson ratio: 0.25/model: elastic-1d, \1Young modulus: 162.132 MPa/; s/form: variational, strain: small, //' \
  "$source/examples/plate-with-crack-1d-3d/rest.yaml" > fibres.yaml
"$breccia" run fibres.yaml --quiet > out 2>&1 || fail "plate of fibres: $(cat out)"
near "opening of the crack, fibres" "$(value fibres/mouth 4)" 0.003292 0.002

# Under the sanitizers that is enough: what follows has the same laws and solvers on larger bodies.
[ -z "${BRECCIA_SANITIZED:-}" ] || { finish; exit; }

# Prandtl: (2 + pi) s_u on 1 m x 1 m, s_u = 100 kPa; 5 particles under half of the footing carry 14 % more. The ground is
# coarse: 10 particles carry less. Families at the ground surface were too stiff along the surface and yielded too soon,
# which hid 2 % of the error.
run footing/footing --set "variables.dx=200 mm" --set "variables.settlement=9 mm" --set "solve.static.increments=6"
near "limit load of the footing" "$(cut -d, -f4 footing/footing.csv | sort -gr | head -1)" 514.16 0.15

# A dam with the mass of its water: 2.64 Hz by finite elements (examples/dam-shaken/elements.py). Shaken, it cracks at its neck, and neither above nor in the body below
"$breccia" modes "$source/examples/dam-shaken/dam.yaml" --count 1 --set variables.columns=8 --output modes > out 2>&1 || fail "modes of the dam: $(cat out)"
near "first frequency of the dam" "$(sed -n 2p modes/modes.csv | cut -d, -f2)" 2.64 0.06
run dam-shaken/dam --set variables.columns=8 --set "variables.shaken=1.8 s"
near "plastic strain in the neck of the dam" "$(value dam/neck 3)" 2e-5 0.5
equal "cracks elsewhere in the dam" "$(awk -v a="$(value dam/head 3)" -v b="$(value dam/body 3)" 'BEGIN {print a + b < 1e-7}')" 1

# On rock its weight stays where it is when what held the rock is let go and dashpots take over: in a tenth of a second it would fall by 49 mm, and the crest is 4 mm lower by the weight
run dam-shaken/rock --set variables.columns=8 --set "variables.shaken=0.1 s"
near "crest of the dam as its rock is let go" "$(value rock/crest 4)" "$(sed -n 3p rock/crest.csv | cut -d, -f4)" 0.02

# Slip circles: 1.47
run slope/slope --set "variables.dx=2 m"
equal "the slope stands at 1.3" "$(json slope/summary.json completed)" true
"$breccia" run "$source/examples/slope/slope.yaml" --quiet --output fallen --set "variables.dx=2 m" --set "variables.factor=1.6" > out 2>&1
equal "the slope falls at 1.6: status" $? 1
contains "the slope falls at 1.6" "$(cat out)" "static: no equilibrium"

# A crack in a plate that repeats for ever may be drawn in the middle of a period or across its ends; the layers outside do not count in what was largest
cat > middle.yaml <<'DECK'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.2}}
peridynamics: {formulation: correspondence, space: plane strain}
body: {b: {material: m, lattice: square, spacing: 0.05, thickness: 1, shape: {box: {from: [0, 0], to: [1, 1]}}}}
variables: {x: 0.525}
cracks: [{cut: {line: [[0.3, 0.5], [0.7, 0.5]]}}]
loads:
  - {on: {face: x-}, support: {held: periodic}}
  - {on: {face: y-, layers: 3}, displacement: [0, 0]}
  - {on: {face: y+}, traction: [0, 1 kPa]}
solve: {static: {increments: 1}}
watch: {mouth: {opening between: [["${x}", 0.475], ["${x}", 0.525]], every: 1}}
pictures: []
DECK
sed 's/x: 0.525/x: 0.025/; s/^cracks:.*/cracks: [{cut: {line: [[0, 0.5], [0.2, 0.5]]}}, {cut: {line: [[0.8, 0.5], [1, 0.5]]}}]/' middle.yaml > ends.yaml
for deck in middle ends; do "$breccia" run $deck.yaml --quiet > out 2>&1 || fail "crack in the $deck: $(cat out)"; done
near "opening across the ends of a period" "$(value ends/mouth 4)" "$(value middle/mouth 4)" 1e-7
largest() { sed -n 's/.*"octahedral_shear_stress": \([^,]*\),.*/\1/p' "$1/summary.json"; }
near "largest stress across the ends of a period" "$(largest ends)" "$(largest middle)" 1e-7
finish

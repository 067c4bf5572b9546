# Parameters for concrete as a lattice of links from its strengths, and that the block for a deck runs as it is printed.
. "$(dirname "$0")/common.sh"
cd "$work"

concrete() { "$breccia" calibrate concrete "$@" > out 2> errors; }
# parameter NAME: the number in the block
parameter() { sed -n "s/^    $1: \([0-9.e+-]*\).*/\1/p" out; }
# near WHAT FOUND EXPECTED TOLERANCE
near() {
  checks=$((checks + 1))
  awk -v f="$2" -v e="$3" -v t="$4" 'BEGIN {exit !(f != "" && f >= e * (1 - t) && f <= e * (1 + t))}' || fail "$1: expected $3, found «$2»"
}
# bears MODE: the two shares of the strength wanted between which plates fail
bears() { sed -n "s/^#   in $1 between .*, \([0-9.]*\) to \([0-9.]*\) of the strength wanted$/\1 \2/p" out; }

# ---- the thesis: 4000 psi has 251.3 psi in tension, 3.605e6 psi, stretches 0.87 f_t / E and 0.88 f_c / E ----
concrete --fc 4000psi; equal "4000 psi: status" $? 0
cp out thesis
equal "4000 psi: nothing to say" "$(cat errors)" ""
near "4000 psi: E" "$(parameter "Young modulus")" 3.605e6 1e-4
near "4000 psi: S_t" "$(parameter "tensile stretch")" 6.065e-5 1e-3
near "4000 psi: S_c" "$(parameter "compressive stretch")" 9.764e-4 1e-3
contains "4000 psi: units" "$(cat out)" "density: 145 lb/ft3"
read -r low high <<< "$(bears tension)"
near "4000 psi: tension, low" "$low" 1.02 0.03
near "4000 psi: tension, high" "$high" 1.03 0.03
read -r low high <<< "$(bears compression)"
near "4000 psi: compression, low" "$low" 0.99 0.02
near "4000 psi: compression, high" "$high" 0.99 0.02
concrete --fc '27.57902917 MPa' --density '145 lb/ft3' --unverified; equal "27.6 MPa: status" $? 0
contains "27.6 MPa: units" "$(cat out)" "MPa: 0.33 sqrt(w f_c)"
near "27.6 MPa: E" "$(parameter "Young modulus")" 24856 1e-3
for key in "tensile stretch" "compressive stretch"; do near "27.6 MPa: $key" "$(parameter "$key")" "$(sed -n "s/^    $key: //p" thesis)" 1e-3; done
near "27.6 MPa: the same f_t" "$(sed -n 's/^#   f_t *\([0-9.]*\) MPa.*/\1/p' out)" 1.733 1e-3 # 251.3 psi

# ---- strengths of the other kind, and a fracture energy of CEB-FIP 1990: 16 mm, 30 MPa: 30.006 N/m 3^0.7 ----
concrete --ft 251.3psi --unverified; equal "by f_t: status" $? 0
near "by f_t: E" "$(parameter "Young modulus")" 3.605e6 1e-3
once= # under the sanitizers plates have run once
[ -z "${BRECCIA_SANITIZED:-}" ] || once=--unverified
concrete --fc 30MPa --aggregate 16mm $once; equal "aggregate: status" $? 0
near "aggregate: G_F" "$(parameter "fracture energy")" 64.74 1e-3
contains "aggregate: spacing" "$(cat out)" "{lattice: hexagonal, spacing: 16 mm}"
case $(cat out) in *ductility:\ 2*tensile\ ductility*) fail "aggregate: both a ductility and a fracture energy" ;; esac
cp out whole
concrete --fc 30MPa --aggregate 16mm --initial-fracture-energy '39 N/m' --unverified; equal "two lines: status" $? 0
near "two lines: G_f" "$(parameter "initial fracture energy")" 39 1e-6
cp whole out
# Under the sanitizers that is enough: plates have run in what was verified.
[ -z "${BRECCIA_SANITIZED:-}" ] || { finish; exit; }
read -r low high <<< "$(bears tension)"
near "aggregate: what plates bear in tension" "$high" 1.005 0.01
near "aggregate: what plates bear in tension" "$low" 0.995 0.01

# ---- the block runs as it is printed: under 0.9 of what plates bear one is steady, under 1.1 it fails ----
cp out concrete.yaml
for load in 0.9 1.1; do
  awk -v s="$load" 'BEGIN {f = s * 1.837e6 * 15 * 0.016 * 0.016; printf "include: concrete.yaml\nunits: {length: m, force: N, time: s}\n"
    print "body: {plate: {material: concrete, lattice: hexagonal, spacing: 16 mm, thickness: 16 mm, shape: {box: {particles: [15, 41]}}}}"
    printf "loads: [{on: {face: y+, layers: 3}, force: [0, %g]}, {on: {face: y-, layers: 3}, force: [0, %g]}]\nsolve: {explicit: {quasi-static: {}}}\n", f, -f}' > plate.yaml
  "$breccia" run plate.yaml --output "plate-$load" > log 2>&1; equal "the block under $load: status" $? 0
  contains "the block under $load" "$(cat log)" "quasi-static: $([ $load = 0.9 ] && echo steady || echo failed)"
done

# ---- pulled along the rows of its lattice it bears another stress, which is told: links across it are whole when those along it soften ----
read -r low high <<< "$(bears "tension along the rows of the lattice")"
near "along the rows" "$low" 1.28 0.04
for share in 0.95 1.05; do
  awk -v s="$(awk -v l="$low" -v h="$high" -v f="$share" 'BEGIN {print f * (l + h) / 2}')" 'BEGIN {
    d = 0.016; f = s * 1.837e6 * 15 * sqrt(0.75) * d * d; printf "include: concrete.yaml\nunits: {length: m, force: N, time: s}\n"
    print "body: {plate: {material: concrete, lattice: hexagonal, spacing: 16 mm, thickness: 16 mm, shape: {box: {particles: [81, 15]}}}}"
    printf "loads: [{on: {inside: {box: {from: [%g, -1], to: [9, 9]}}}, force: [%g, 0]}, {on: {inside: {box: {from: [-1, -1], to: [%g, 9]}}}, force: [%g, 0]}]\n", 78.25 * d, f, 3.25 * d, -f
    print "solve: {explicit: {quasi-static: {hold: 10}}}"}' > along.yaml
  "$breccia" run along.yaml --output "along-$share" > log 2>&1; equal "along the rows, under $share: status" $? 0
  contains "along the rows, under $share" "$(cat log)" "quasi-static: $([ $share = 0.95 ] && echo steady || echo failed)"
done

# ---- advice does not contradict what quasi-static loading does by itself ----
"$breccia" check plate.yaml > out 2>&1; equal "check: status" $? 0
contains "check: loads" "$(cat out)" "as 'quasi-static' asks for"
contains "check: frequency" "$(cat out)" "lowest frequency as the body is held"
case $(cat out) in *"waves will show"* | *soonest*) fail "check advises against quasi-static loading: $(cat out)" ;; esac
cat > held.yaml <<'Y'
materials: {m: {model: elastic, density: 2400 kg/m3, Young modulus: 25 GPa, Poisson ratio: 0.2}}
body: {plate: {material: m, lattice: square, spacing: 20 mm, thickness: 20 mm, shape: {box: {particles: [10, 15]}}}}
peridynamics: {formulation: correspondence, space: plane stress}
loads: [{on: {face: y-}, support: {held: all}}, {on: {face: y+, layers: 3}, force: [0, 1 kN]}]
solve: {explicit: {quasi-static: {}}}
Y
"$breccia" check held.yaml > out 2>&1
contains "held: all" "$(cat out)" "take 'stiffness damping"
case $(cat out) in *"local damping"*) fail "a damping that quasi-static loading refuses is advised: $(cat out)" ;; esac

# ---- what is refused ----
# refused WORDS OPTIONS...
refused() {
  local words=$1
  shift
  concrete "$@"; equal "$*: status" $? 2
  contains "$*" "$(cat errors)" "$words"
  equal "$*: lines" "$(wc -l < errors)" 1
  [ -s out ] && fail "$*: something was printed: $(cat out)"
}
refused "give the strength of the concrete"
refused "fc: '4000' is out of range for concrete; expected 1 MPa to 250 MPa, like 4000psi" --fc 4000
refused "fc: '30m' has the wrong dimension; expected a stress" --fc 30m
refused "fc: 'strong'" --fc strong
refused "ft: '4MPa' is not below the strength in compression, '3MPa'" --ft 4MPa --fc 3MPa
refused "poisson: '0.4' is out of range for concrete; expected 0 to 1/3" --fc 30MPa --poisson 0.4
refused "fracture-energy: '1e-3 N/m' is out of range" --fc 30MPa --fracture-energy '1e-3 N/m'
refused "initial-fracture-energy: '70 N/m' is a part of the fracture energy, which is no larger; give more by" --fc 30MPa --aggregate 16mm --initial-fracture-energy '70 N/m'
refused "initial-fracture-energy: '70 N/m' is a part of the fracture energy, which is not given; give more by" --fc 30MPa --initial-fracture-energy '70 N/m'
refused "plates of this concrete: its links store" --fc 30MPa --fracture-energy '1 N/m'
refused "take a spacing 1.28 times smaller" --fc 30MPa --fracture-energy '1 N/m'
refused "--picture is for measured curves" --fc 30MPa --picture a.png
"$breccia" calibrate test.yaml --fc 30MPa 2> errors; equal "a strength for a file: status" $? 2
contains "a strength for a file" "$(cat errors)" "--fc is for 'breccia calibrate concrete'"

finish

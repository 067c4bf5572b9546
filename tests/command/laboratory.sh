# Laboratory tests: where strain is zero, measured points and their mistakes, parameters fitted to points.
. "$(dirname "$0")/common.sh"
cd "$work"

# near WHAT FOUND EXPECTED TOLERANCE (relative to EXPECTED, absolute about 0)
near() {
  checks=$((checks + 1))
  awk -v f="$2" -v e="$3" -v t="$4" 'BEGIN {s = e < 0 ? -e : e; if (s == 0) s = 1; d = f - e; if (d < 0) d = -d; exit !(f != "" && d <= t * s)}' ||
    fail "$1: expected $3, found «$2»"
}
# cell FILE ROW COLUMN: row 1 is the first of numbers; "last" is the last
cell() {
  awk -F, -v row="$2" -v name="$3" 'NR == 1 {for (k = 1; k <= NF; ++k) {sub(/ \(.*/, "", $k); if ($k == name) c = k}}
    NR > 1 {value = $c} row != "last" && NR == row + 1 {print value; exit} END {if (row == "last") print value}' "$1"
}

# ---- strain is zero after consolidation ----
# E = 40 MPa, nu = 0.3 at 100 kPa: the deviator is E times the axial strain, and that shortens by 100 kPa (1 - 2 nu) / E = 1e-3 before.
elastic() { "$breccia" material --model elastic --set "Young modulus=40 MPa" --set "Poisson ratio=0.3" --units m,kN,s --confining 100 --steps 4 "$@"; }
elastic --test triaxial --to -0.01 > triaxial.csv || fail "triaxial test"
equal "triaxial: rows" "$(wc -l < triaxial.csv)" 6
for name in "strain xx" "strain yy" "strain zz" "volumetric strain"; do near "triaxial: first $name" "$(cell triaxial.csv 1 "$name")" 0 1e-15; done
for name in xx yy zz; do near "triaxial: stress $name stays total" "$(cell triaxial.csv 1 "stress $name")" -100 1e-9; done
near "triaxial: axial strain" "$(cell triaxial.csv last "strain xx")" -0.01 1e-9
near "triaxial: axial stress" "$(cell triaxial.csv last "stress xx")" -500 1e-6
near "triaxial: lateral stress" "$(cell triaxial.csv last "stress yy")" -100 1e-6
near "triaxial: volumetric strain" "$(cell triaxial.csv last "volumetric strain")" -0.004 1e-6
elastic --test triaxial --to -0.01 --strain-zero "before consolidation" > total.csv
near "total strain: first stress" "$(cell total.csv 1 "stress xx")" 0 1e-12
near "total strain: at the end" "$(cell total.csv last "strain xx")" -0.011 1e-6
near "total strain: volumetric" "$(cell total.csv last "volumetric strain")" -0.007 1e-6
elastic --test triaxial --to -0.01 --strain-zero after 2> errors; equal "strain zero: status" $? 2
contains "strain zero" "$(cat errors)" "--strain-zero 'after' is not known; choose 'after consolidation' or 'before consolidation'"
elastic --test "undrained triaxial" --to -0.01 > undrained.csv
near "undrained: first stress" "$(cell undrained.csv 1 "stress xx")" -100 1e-9
for row in 1 2 3 4 5; do near "undrained: volumetric strain in row $row" "$(cell undrained.csv $row "volumetric strain")" 0 1e-15; done
near "undrained: deviator 3 G" "$(awk -F, 'END {print $7 - $8}' undrained.csv)" -461.538461538 1e-6
elastic --test oedometer --to -0.01 > oedometer.csv
near "oedometer: first strain" "$(cell oedometer.csv 1 "strain xx")" 0 1e-15
near "oedometer: lateral strain" "$(cell oedometer.csv last "strain yy")" 0 1e-15
near "oedometer: stress" "$(cell oedometer.csv last "stress xx")" -638.461538462 1e-6
elastic --test biaxial --to -0.01 > biaxial.csv
near "biaxial: strain zz" "$(cell biaxial.csv last "strain zz")" 0 1e-15
near "biaxial: stress E / (1 - nu^2)" "$(cell biaxial.csv last "stress xx")" -539.56043956 1e-6
elastic --test isotropic --to -0.001 > isotropic.csv
near "isotropic: volumetric strain" "$(cell isotropic.csv last "volumetric strain")" -0.003 1e-9
near "isotropic: mean stress" "$(cell isotropic.csv last "stress zz")" -200 1e-6
elastic --test "simple shear" --to 0.001 > shear.csv
near "simple shear: first strain yy" "$(cell shear.csv 1 "strain yy")" 0 1e-15
near "simple shear: stress" "$(cell shear.csv last "stress xy")" 15.3846153846 1e-6
elastic --test triaxial --to -0.01 --return 0.002 --cycles 2 > cyclic.csv
near "cycles: first reversal" "$(cell cyclic.csv 5 "strain xx")" -0.01 1e-9
near "cycles: back" "$(cell cyclic.csv last "strain xx")" 0.002 1e-9
near "cycles: elastic" "$(cell cyclic.csv last "stress xx")" -20 1e-6

# Stages of one's own: total strains, or from the end of what is called consolidation.
cat > stages.yaml <<'Y'
units: {length: m, force: kN, time: s}
material: {model: elastic, density: 2 t/m3, Young modulus: 40 MPa, Poisson ratio: 0.3}
stages:
  - {stress xx: -50, stress yy: -50, stress zz: -50, consolidation: yes, steps: 2}
  - {stress xx: -100, stress yy: -50, stress zz: -50, consolidation: yes, steps: 2}
  - {strain xx: -0.01, stress yy: -50, stress zz: -50, steps: 4}
Y
"$breccia" material stages.yaml > stages.csv || fail "stages with consolidation"
equal "stages: rows" "$(wc -l < stages.csv)" 6
near "stages: first strain" "$(cell stages.csv 1 "strain xx")" 0 1e-15
near "stages: first stress" "$(cell stages.csv 1 "stress xx")" -100 1e-9
near "stages: strain from there" "$(cell stages.csv last "strain xx")" -0.01 1e-9
near "stages: stress" "$(cell stages.csv last "stress xx")" -500 1e-6
sed 's/, consolidation: yes//' stages.yaml > total.yaml
"$breccia" material total.yaml > total.csv || fail "stages without consolidation"
near "stages, total: first stress" "$(cell total.csv 1 "stress xx")" 0 1e-15
near "stages, total: stress" "$(cell total.csv last "stress xx")" -430 1e-6
sed '0,/, consolidation: yes/s///' stages.yaml > late.yaml
"$breccia" material late.yaml 2> errors; equal "late consolidation: status" $? 2
contains "late consolidation" "$(cat errors)" "late.yaml:5:70: stage: consolidation comes before all other stages"
sed '$d' stages.yaml > only.yaml
"$breccia" material only.yaml 2> errors; equal "nothing but consolidation: status" $? 2
contains "nothing but consolidation" "$(cat errors)" "stages: all of them are consolidation"

# Exact triaxial data in a fit: 40 MPa, not what the consolidation makes of it.
cat > triaxial.yaml <<'Y'
units: {length: m, force: kN, time: s}
material: {model: elastic, density: 2 t/m3, Young modulus: 20 MPa, Poisson ratio: 0.3}
test: {kind: triaxial, strain: -0.005, confining pressure: 100 kPa, steps: 20}
against: points.csv
fit: {Young modulus: {from: 1e4, to: 1e5}}
Y
for k in 0 1 2 3 4 5 6 7 8 9 10; do awk -v k=$k 'BEGIN {e = -0.0005 * k; print e "," 40000 * e}'; done > points.csv
fitted() { sed -n "s/^  $1: \([0-9.e+-]*\) .*/\1/p" out; }
"$breccia" calibrate triaxial.yaml > out 2> errors; equal "calibrate triaxial: status" $? 0
near "calibrate triaxial: 40 MPa" "$(fitted "Young modulus")" 40000 1e-4
# the same with total strains, as somebody would write who subtracts nothing
awk -F, '{print $1 - 0.001 "," $2}' points.csv > moved.csv
sed 's/steps: 20/steps: 20, strain zero: before consolidation/' triaxial.yaml > moved.yaml
"$breccia" calibrate moved.yaml --against moved.csv > out 2> errors; equal "calibrate with total strains: status" $? 0
near "calibrate with total strains: 40 MPa" "$(fitted "Young modulus")" 40000 1e-3
finish

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

# ---- laws that take time ----
# Sheared at an even rate over two relaxation times: v = 0.01 (2 - (1 - exp(-2))) / 2, stress G (0.01 - v / 2); held: half of it goes with exp(-t).
slow() { "$breccia" material --model viscoelastic --set "shear modulus=100 MPa" --set "bulk modulus=200 MPa" --set "relaxing share=0.5" --set "relaxation time=1" "$@"; }
slow --test "undrained shear" --to 0.01 --steps 4 --duration "2 s" > slow.csv 2> errors || fail "a test that takes time"
near "slow shear: stress" "$(cell slow.csv last "stress xy")" 716166.179190847 1e-9
equal "slow shear: nothing to say" "$(cat errors)" ""
slow --test "undrained shear" --to 0.01 --steps 4 > slow.csv 2> errors || fail "a test without time"
near "at once: stress" "$(cell slow.csv last "stress xy")" 1e6 1e-9
contains "at once" "$(cat errors)" "viscoelastic depends on time, of which this test takes none"
slow --test "undrained shear" --to 0.01 --duration "2 m" 2> errors; equal "duration: status" $? 2
slow --test "undrained shear" --to 0.01 --duration "-2 s" 2> errors; equal "negative duration: status" $? 2
printf 'time,strain xx,strain yy,strain zz,strain xy,strain yz,strain zx\n0,0,0,0,0.01,0,0\n2,0,0,0,0.01,0,0\n' > held.csv
slow --strain held.csv > slow.csv 2> errors || fail "a path that takes time"
near "held: first" "$(cell slow.csv 1 "stress xy")" 1e6 1e-9
near "held: later" "$(cell slow.csv last "stress xy")" 567667.641618306 1e-9
printf '1,0,0,0,0.01,0,0\n' >> held.csv
slow --strain held.csv 2> errors; equal "falling time: status" $? 2
contains "falling time" "$(cat errors)" "row 3: time must be a number that does not fall"

cat > stages-held.yaml <<'Y'
material: {model: viscoelastic, density: 2 t/m3, shear modulus: 100 MPa, bulk modulus: 200 MPa, relaxing share: 0.5, relaxation time: 1 s}
stages:
  - {strain xy: 0.01, steps: 1}
  - {strain xy: 0.01, steps: 4, duration: 2 s}
Y
"$breccia" material stages-held.yaml > slow.csv 2> errors || fail "stages that take time: $(cat errors)"
near "stages, at once" "$(cell slow.csv 2 "stress xy")" 1e6 1e-9
near "stages, held" "$(cell slow.csv last "stress xy")" 567667.641618306 1e-9

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

# ---- what every test keeps ----
# lasts KIND OPTIONS COLUMN=VALUE ...: of E = 40 MPa, nu = 0.3 (K = 33.3, G = 15.4 MPa) under 100 kPa, at the end of the test
lasts() {
  local kind=$1 options=$2 pair
  shift 2
  elastic --test "$kind" $options > kept.csv 2> errors || fail "$kind: $(cat errors)"
  for pair; do near "$kind $options: ${pair%=*}" "$(cell kept.csv last "${pair%=*}")" "${pair#*=}" 1e-6; done
}
lasts triaxial "--to -0.01" "stress xx=-500" "stress yy=-100" "stress zz=-100" "stress xy=0" "strain yy=0.003" "strain zz=0.003"
lasts "undrained triaxial" "--to -0.01" "strain yy=0.005" "strain zz=0.005" "stress xx=-407.6923076923" "stress yy=53.8461538462" "stress zz=53.8461538462"
lasts oedometer "--to -0.01" "strain yy=0" "strain zz=0" "stress yy=-330.7692307692" "stress zz=-330.7692307692"
# plane strain across zz, and yy is free: eps_yy = nu / (1 - nu) 0.01, s_zz = nu s_xx beyond the confining
lasts biaxial "--to -0.01" "stress yy=-100" "strain zz=0" "strain yy=0.0042857143" "stress zz=-231.8681318681"
lasts isotropic "--to -0.001" "strain yy=-0.001" "stress xx=-200" "stress yy=-200" "stress xy=0"
lasts "simple shear" "--to 0.001" "stress yy=-100" "strain xx=0" "strain yy=0" "strain zz=0" "stress xx=-100"
lasts "undrained shear" "--to 0.001" "stress xy=15.3846153846" "strain xx=0" "strain yy=0" "strain zz=0" "stress yy=-100"

# ---- an elastic stage is as many rows as asked for ----
printf 'strain xx\n0.01\n0.02\n0.03\n0.04\n' > path.csv
for rows in 0 1 3; do
  "$breccia" material --model elastic-perfectly-plastic --set "Young modulus=100" --set "yield stress=0.5" --strain path.csv --elastic-rows $rows > out 2> errors ||
    fail "elastic rows: $(cat errors)"
  for row in 1 2 3 4; do
    if [ $row -le $rows ]; then stress=$row; else stress=0.5; fi
    near "$rows elastic rows: row $row" "$(cell out $row "stress xx")" $stress 1e-12
  done
done

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
# measured points lie beside the file that names them, wherever the command is given; other points of that name here are not asked
mkdir -p beside elsewhere
cp triaxial.yaml points.csv beside/
awk -F, '{print $1 "," 2 * $2}' points.csv > elsewhere/points.csv
(cd elsewhere && "$breccia" calibrate ../beside/triaxial.yaml) > out 2> errors; equal "calibrate from elsewhere: status" $? 0
near "calibrate from elsewhere: 40 MPa" "$(fitted "Young modulus")" 40000 1e-4
# the same with total strains, as somebody would write who subtracts nothing
awk -F, '{print $1 - 0.001 "," $2}' points.csv > moved.csv
sed 's/steps: 20/steps: 20, strain zero: before consolidation/' triaxial.yaml > moved.yaml
"$breccia" calibrate moved.yaml --against moved.csv > out 2> errors; equal "calibrate with total strains: status" $? 0
near "calibrate with total strains: 40 MPa" "$(fitted "Young modulus")" 40000 1e-3
# ---- exact points give their parameters back ----
# recover NAME TOLERANCE LAW TEST COLUMNS GIVEN TRUE FIT: material with TRUE makes the points, FIT is what calibrate may choose from
recover() {
  local units="units: {length: mm, force: N, time: s}"
  printf '%s\nmaterial: {model: %s, density: 2e-9, %s, %s}\ntest: %s\n' "$units" "$3" "$6" "$7" "$4" > true.yaml
  "$breccia" material true.yaml > true.csv || fail "$1: the test does not run"
  awk -F, -v x="${5%:*}" -v y="${5#*:}" 'NR > 1 {split(y, c, "-"); print $x "," (c[2] ? $c[1] - $c[2] : $y)}' true.csv > true-points.csv
  printf '%s\nmaterial: {model: %s, density: 2e-9, %s, %s}\ntest: %s\nfit: {%s}\n' "$units" "$3" "$6" \
    "$(echo "$8" | sed 's/{from: [^,]*, to: \([^}]*\)}/\1/g')" "$4" "$8" > fit.yaml
  "$breccia" calibrate fit.yaml --against true-points.csv > out 2> errors || fail "$1: $(cat errors)"
  echo "$7" | tr ',' '\n' | while IFS=: read -r key value; do echo "${key# }:$value"; done > wanted
  while IFS=: read -r key value; do near "$1: $key" "$(fitted "$key")" "$value" "$2"; done < wanted
}
recover "J2 under cycles" 1e-3 j2 "{kind: uniaxial, strain: 0.01, cycles: 2, steps: 50}" 1:7 "Poisson ratio: 0.3" \
  "Young modulus: 200000, yield stress: 250, saturation stress: 300, saturation rate: 30, kinematic modulus: 4000" \
  "Young modulus: {from: 50e3, to: 500e3}, yield stress: {from: 100, to: 600}, saturation stress: {from: 250, to: 900}, saturation rate: {from: 2, to: 200}, kinematic modulus: {from: 100, to: 20000}"
cp out first
"$breccia" calibrate fit.yaml --against true-points.csv > again; cmp -s again first || fail "the same points do not give the same fit"
recover "drucker-prager in a triaxial cell" 1e-3 drucker-prager "{kind: triaxial, strain: -0.03, confining pressure: 0.1, steps: 60}" 1:7-8 \
  "Poisson ratio: 0.3, friction angle: 30, dilation angle: 5" "Young modulus: 40, cohesion: 0.01, hardening modulus: 0.5" \
  "Young modulus: {from: 5, to: 500}, cohesion: {from: 0.001, to: 0.1}, hardening modulus: {from: 0.01, to: 10}"
recover "clay in simple shear" 1e-3 multi-yield-j2 "{kind: simple shear, strain: 0.02, steps: 60}" 4:10 "bulk modulus: 100" \
  "shear modulus: 60, octahedral strength: 0.03" "shear modulus: {from: 5, to: 500}, octahedral strength: {from: 0.005, to: 0.5}"
recover "clay under cycles" 1e-3 bounding-surface-clay "{kind: undrained shear, strain: 0.004, cycles: 1, steps: 60}" 4:10 "bulk modulus: 100" \
  "shear modulus: 60, undrained strength: 0.03, hardening modulus: 60" \
  "shear modulus: {from: 5, to: 500}, undrained strength: {from: 0.005, to: 0.5}, hardening modulus: {from: 5, to: 500}"
recover "concrete that crushes" 1e-3 mazars "{kind: uniaxial, strain: -0.005, steps: 60}" 1:7 "Poisson ratio: 0.2, length: 50, fracture energy: 0.1, tensile strength: 3" \
  "Young modulus: 30000, compression share: 1.2, compression rate: 1500" \
  "Young modulus: {from: 10e3, to: 60e3}, compression share: {from: 1, to: 1.5}, compression rate: {from: 800, to: 3000}"
recover "a bar of steel" 1e-3 menegotto-pinto "{kind: uniaxial, strain: 0.01, cycles: 2, steps: 50}" 1:2 "initial stress: 0" \
  "Young modulus: 200000, yield stress: 400, hardening ratio: 0.02, roundness: 15" \
  "Young modulus: {from: 50e3, to: 500e3}, yield stress: {from: 100, to: 1000}, hardening ratio: {from: 0.001, to: 0.1}, roundness: {from: 5, to: 30}"
recover "a bar of bilinear steel" 1e-3 steel-bilinear "{kind: uniaxial, strain: 0.006, steps: 60}" 1:2 "compression shift: 0" \
  "Young modulus: 200000, yield stress: 400, hardening ratio: 0.02" \
  "Young modulus: {from: 20e3, to: 2000e3}, yield stress: {from: 40, to: 1000}, hardening ratio: {from: 0.001, to: 0.1}"

# In a uniaxial compression cohesion and friction angle act only together: 2 c cos f / (1 - sin f) is all that shows.
"$breccia" material --model mohr-coulomb --set "Young modulus=50" --set "Poisson ratio=0.3" --set cohesion=0.02 --set "friction angle=30" \
  --set "dilation angle=5" --units mm,N,s --test uniaxial --to -0.004 --steps 40 | awk -F, 'NR > 1 {print $1 "," $7}' > true-points.csv
cat > fit.yaml <<'Y'
units: {length: mm, force: N, time: s}
material: {model: mohr-coulomb, density: 2e-9, Young modulus: 20, Poisson ratio: 0.3, cohesion: 0.01, friction angle: 20, dilation angle: 5}
test: {kind: uniaxial, strain: -0.004, steps: 40}
against: true-points.csv
fit: {Young modulus: {from: 5, to: 500}, cohesion: {from: 0.002, to: 0.2}, friction angle: {from: 5, to: 45}}
Y
"$breccia" calibrate fit.yaml > out 2> errors; equal "cohesion and friction: status" $? 0
near "cohesion and friction: E" "$(fitted "Young modulus")" 50 1e-3
near "cohesion and friction: strength" "$(awk -v c="$(fitted cohesion)" -v f="$(fitted "friction angle")" 'BEGIN {f *= atan2(0, -1) / 180; print 2 * c * cos(f) / (1 - sin(f))}')" 0.0692820323 1e-3
sed 's/^fit:.*/fit: {Young modulus: {from: 5 MPa, to: 0.5 GPa}, cohesion: {from: 2 kPa, to: 200 kPa}, friction angle: {from: 5 deg, to: 45 deg}}/' fit.yaml > units.yaml
"$breccia" calibrate units.yaml > with-units 2>&1; cmp -s with-units out || fail "ranges with units: $(cat with-units)"
sed 's/^fit:.*/fit: {Young modulus: {from: 5 mm, to: 500}}/' fit.yaml > units.yaml
"$breccia" calibrate units.yaml > with-units 2>&1; contains "a range of millimetres" "$(cat with-units)" "units.yaml:5:29: from: '5 mm' has the wrong dimension; expected a stress"
contains "cohesion and friction" "$(grep cohesion: out)" "these points tell it only together with 'friction angle'"
contains "cohesion and friction" "$(grep "friction angle:" out)" "these points tell it only together with 'cohesion'"
case $(grep "Young" out) in *"only together"*) fail "E is told by itself: $(cat out)" ;; esac

# A standard deviation means what it says: E of a bar from 40 points with alternating errors of s is known to s / sqrt(sum of squared strains).
awk 'BEGIN {for (k = 1; k <= 40; ++k) {e = k * 1e-4; print e "," 1000 * e + (k % 2 ? 0.1 : -0.1)}}' > true-points.csv
cat > fit.yaml <<'Y'
units: {length: mm, force: N, time: s}
material: {model: elastic-1d, density: 2e-9, Young modulus: 500}
test: {kind: uniaxial, strain: 0.005, steps: 50}
against: true-points.csv
fit: {Young modulus: {from: 500, to: 2000}}
Y
"$breccia" calibrate fit.yaml > out 2> errors; equal "a bar with scatter: status" $? 0
# 0.1 sqrt(40 / 39) / (1e-4 sqrt(40 41 81 / 6)) = 6.807, 0.68 % of 1000
contains "a bar with scatter" "$(cat out)" "standard deviation 0.68 %"

# Two points at the same strain, 0.4 above and below a line through all others, whose range is 3.9: each is off by 0.4 / 3.9 / sqrt(2) of that, 7.25 %,
# and the mean square of all 42 is sqrt(2 / 42) of it.
awk 'BEGIN {for (k = 1; k <= 40; ++k) {e = k * 1e-4; print e "," 1000 * e; if (k == 20) print "0.002,2.4\n0.002,1.6"}}' > true-points.csv
sed -i 's/strain: 0.005/strain: 0.0041/' fit.yaml
"$breccia" calibrate fit.yaml > out 2> errors; equal "two points aside: status" $? 0
near "two points aside: E" "$(fitted "Young modulus")" 1000 2e-3
near "two points aside: rms" "$(sed -n 's/.* lie \([0-9.]*\) %.*/\1/p' out)" 1.58 1e-2
near "two points aside: at most" "$(sed -n 's/.* and \([0-9.]*\) % at most.*/\1/p' out)" 7.25 1e-2
sed 's/Young modulus: 500/Young modulus: 1000/' fit.yaml > line.yaml
"$breccia" material line.yaml > out 2> errors || fail "two points aside, the line itself: $(cat errors)"
contains "two points aside, the line itself" "$(cat out errors)" "lie 1.58 % of their range from the curve (rms), 7.25 % at most"

# ---- mistakes of measured files and of units ----
# told WORDS: the fit of triaxial.yaml with bad.csv warns in one line of these words, and ends well
told() {
  "$breccia" material triaxial.yaml --against bad.csv > out 2> errors; equal "$1: status" $? 0
  contains "$1" "$(cat errors)" "warning: bad.csv$1"
  equal "$1: lines" "$(wc -l < errors)" 1
}
# refused WORDS
refused() {
  "$breccia" calibrate triaxial.yaml --against bad.csv > out 2> errors; equal "$1: status" $? 2
  contains "$1" "$(cat errors)" "bad.csv$1"
  equal "$1: lines" "$(wc -l < errors)" 1
  [ -s out ] && fail "$1: something was fitted: $(cat out)"
}
"$breccia" material triaxial.yaml --against points.csv > out 2> errors
[ -s errors ] && fail "good points are doubted: $(cat errors)"
contains "good points" "$(cat out)" "11 measured points (axial strain, axial less lateral stress in kPa) lie"
: > bad.csv; refused ": the file is empty; expected at least 2 rows of strain and stress with a comma between"
printf 'strain,stress\n' > bad.csv; refused ": there are no numbers; expected at least 2 rows"
printf '\n-0.001,-40\n' > bad.csv; refused ": there is only one point; expected at least 2 rows"
printf 'a,b\n-0.001,-40\n-0.002,\n-0.003,-120\n' > bad.csv; refused ":3: expected strain and stress with a comma between, like '0.001,25.3'; found '-0.002,'"
printf -- '-0,001;-40,0\n-0,002;-80,0\n' > bad.csv; refused ":1: expected strain and stress with a comma between, like '0.001,25.3' (and points in the numbers, no commas); found '-0,001;-40,0'"
printf 'strain,force (kN)\n-0.001,-40\n-0.002,-80\n' > bad.csv; refused ":1: column 2, 'force (kN)': its unit is not one of stress, like kPa"
cp triaxial.csv bad.csv; refused ":1: the first two columns must be strain and stress of the curve; the second is 'strain yy'"
awk -F, '{print (-$1) "," (-$2)}' points.csv > bad.csv; refused ": its strains reach 0.005 and the test goes to -0.005: tension is positive here"
awk -F, '{print 100 * $1 "," $2}' points.csv > bad.csv; told ": its strains reach 0.5 and the test goes to 0.005: if they are in per cent"
awk -F, '{print $1 "," 1000 * $2}' points.csv > bad.csv; told ": its stresses reach 200000 kPa, those of the test 100 kPa: if they are in another unit"
(cat points.csv; echo -0.004,-150; echo -0.003,-120) > bad.csv; told ":12: the strain turns back from -0.005 to -0.004, but the test goes once to its strain"
(cat points.csv; echo -0.006,-240) > bad.csv; told ": 1 of 12 points lie at strains that the test does not reach (it goes from -0.005 to 0): let it go as far; its strains count from the end of the consolidation"
# Units in the heading are obeyed, and blank lines, comments and a spreadsheet's mark are no rows.
(printf '\xef\xbb\xbfaxial strain (%%),deviator (MPa)\r\n# of specimen 3\r\n\r\n'; awk -F, 'NR == 4 {printf "# the second of 3 parts\r\n\r\n"} {printf "%.6g,%.6g\r\n", 100 * $1, $2 / 1000}' points.csv) > good.csv
"$breccia" calibrate triaxial.yaml --against good.csv > out 2> errors; equal "units in the heading: status" $? 0
[ -s errors ] && fail "units in the heading: $(cat errors)"
contains "units in the heading: points" "$(cat out)" "11 points lie"
near "units in the heading: 40 MPa" "$(fitted "Young modulus")" 40000 1e-4
# Megapascals in a file that counts in pascals
printf 'material: {model: elastic, density: 2400, Young modulus: 30000, Poisson ratio: 0.2}\ntest: {kind: uniaxial, strain: 0.001}\n' > plain.yaml
"$breccia" material plain.yaml > out 2> errors; equal "no units: status" $? 0
contains "no units" "$(cat errors)" "warning: plain.yaml: the Young modulus at small strain is 0.03 MPa, which no ground, rock, concrete or metal has: plain numbers are in Pa here; give the unit with the number, like '200 GPa'"
sed -i '1i units: {length: mm, force: N, time: s}' plain.yaml
"$breccia" material plain.yaml > out 2> errors; contains "density in mm, N, s" "$(cat errors)" "the density is 2.4e+15 kg/m3"
equal "density in mm, N, s: lines" "$(wc -l < errors)" 1
printf 'material: {model: drucker-prager, density: 2e3, Young modulus: 40e6, Poisson ratio: 0.3, cohesion: 1e4}\ntest: {kind: uniaxial, strain: -0.01}\n' > null.yaml
"$breccia" material null.yaml > out 2> errors; equal "a missing angle: status" $? 2
contains "a missing angle" "$(cat errors)" "null.yaml:1:1: material (drucker-prager): give 'cohesion' and 'friction angle'"
finish

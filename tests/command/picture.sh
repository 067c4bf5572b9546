# Pictures: every kind can be drawn, has the size and the colours that it should, and wrong wishes are told.
. "$(dirname "$0")/common.sh"
cd "$work"
cat > bar.yaml <<'Y'
title: "Bar: 50 % \"quoted\" & <odd>"
materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 1, shape: {box: {particles: [12, 6, 6]}}}}
loads: [{name: pull, on: {face: x+}, body force: [1, 0, 0]}]
solve: {explicit: {steps: 40}}
watch: {end: {displacement of: {face: x+}}, pull: {load: pull}}
results: {number: 2, fields: [displacement, stress, damage]}
Y
"$breccia" run bar.yaml > out 2>&1 || fail "run: $(cat out)"
for file in plain.png plain.svg plain.pdf; do
  "$breccia" plot bar --field stress --component xx --output $file > out 2>&1 || fail "$file: $(cat out)"
  [ "$(wc -c < $file)" -gt 2000 ] || fail "$file is too small to be a picture"
  checks=$((checks + 1))
done
equal "png" "$(head -c 4 plain.png | tail -c 3)" PNG
contains "svg" "$(head -c 200 plain.svg)" "<svg"
equal "pdf" "$(head -c 4 plain.pdf)" %PDF
"$breccia" plot bar --field displacement --step all --deformed 20 --view 30:40 --output all.png > out || fail "all steps"
equal "all steps" "$(wc -l < out)" 3
"$breccia" plot bar --curve "end.x : pull.value" --output curve.svg > out 2>&1 || fail "curve: $(cat out)"
contains "curve" "$(cat curve.svg)" "<svg"
printf 'a,b\n0,0\n1,1\n' > measured.csv
"$breccia" plot bar bar --curve "end.x:end.y" --overlay measured.csv --output curve.png > out 2>&1 || fail "overlay: $(cat out)"
# histories of laws are fields too
sed 's/model: elastic.*Poisson ratio: 0.2/model: multi-yield-j2, density: 1, shear modulus: 60, bulk modulus: 100, octahedral strength: 1e-3/
     s/damage]/damage, active surface]/' bar.yaml > clay.yaml
"$breccia" run clay.yaml > out 2>&1 || fail "clay: $(cat out)"
"$breccia" plot clay --field "active surface" --output surface.png > out 2>&1 || fail "active surface: $(cat out)"
wrong() { # wrong WORDS ARGUMENTS ...
  words=$1
  shift
  "$breccia" plot "$@" > out 2> errors
  equal "plot $*: status" $? 2
  contains "plot $*" "$(cat errors)" "$words"
}
wrong "there is no field 'colour'" bar --field colour
wrong "choose one" bar --field stress
wrong "none called 'q'" bar --field stress --component q
wrong "was not written; these were: 0, 20, 40" bar --field damage --step 7
wrong "should end in .png, .svg or .pdf" bar --output picture.gif
wrong "there is no such file" nowhere
wrong "has no column 'q'" bar --curve end.q:end.x
wrong "should be watch.column" bar --curve x:y
wrong "two numbers" bar --range 3
wrong "is not a result file" bar.yaml
finish

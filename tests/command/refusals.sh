# What is refused beside decks: files that decks include, tests of the laboratory, results, motions, studies: in one line that says what is wrong.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

# refuse WORDS VERB ARGUMENTS: status 2, one line (or $lines) with the words
refuse() {
  local words=$1
  shift
  timeout 120 "$breccia" "$@" > out 2> errors
  equal "$*: exit status" $? 2
  equal "$*: lines" "$(grep -c . errors)" "${lines:-1}"
  contains "$*" "$(cat errors)" "$words"
}

# ---- files that decks include ----
cat > base.yaml <<'Y2'
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}
solve: {explicit: {steps: 1}}
results: {fields: [displacement, stress]}
Y2
deck() {
  { cat base.yaml; echo "$1"; } > deck.yaml
}
"$breccia" check base.yaml > out 2> errors || fail "the good deck: $(cat errors)"
deck 'include: "more-${n}.yaml"'
refuse "deck.yaml:6:11: include: 'more-\${n}.yaml': names of files hold no expressions" check deck.yaml
deck "include: nowhere.yaml"
refuse "include: nowhere.yaml: No such file or directory" check deck.yaml
deck "include: [list.yaml]"
echo "[1, 2]" > list.yaml
refuse "an included file holds keys and values" check deck.yaml
deck "include: deck.yaml"
refuse "includes itself" check deck.yaml
deck "include: {a: 1}"
refuse "include: expected the name of a file, or a list of names" check deck.yaml

# ---- particles of a file ----
sed 's/^body: .*/body: {b: {material: m, spacing: 0.1, file: p.csv}}/' base.yaml > cloud.yaml
echo "x,y,z,volume" > p.csv
refuse "p.csv" check cloud.yaml
printf 'x,y,z,volume\n0,0,0,1e-3\n0.1,0,0,-1e-3\n' > p.csv
refuse "file: 'p.csv', particle 1: its volume must be a number above 0" check cloud.yaml
printf 'x,y,z,volume\n0,0,0,1e-3\nnan,0,0,1e-3\n' > p.csv
refuse "file: 'p.csv', particle 1: its x is not a number" check cloud.yaml

# ---- tests of the laboratory ----
material="units: {length: m, force: kN, time: s}
material: {model: drucker-prager, density: 2, Young modulus: 5e4, Poisson ratio: 0.3, cohesion: 20, friction angle: 30 deg}"
printf '%s\nstages: [{strain xx: 1e-3, stress xx: 2}]\n' "$material" > stage.yaml
refuse "stage: give 'strain xx' or 'stress xx', not both" material stage.yaml
printf '%s\n' "$material" > none.yaml
refuse "give either 'test' or 'stages'" material none.yaml
printf '%s\nstages: [{strain xx: 1e-3}]\nfit: {cohesion: {from: 5, to: 50}}\n' "$material" > fit.yaml
refuse "no measured points: give 'against' or --against" calibrate fit.yaml
printf 'a,b\n1e-3,1\n2e-3,2\n' > points.csv
printf '%s\nstages: [{strain xx: 1e-3}]\nfit: {cohesion: {from: 5, to: 50}, friction angle: {from: 20 deg, to: 40 deg}, Young modulus: {from: 1e4, to: 1e5}}\n' "$material" > fit.yaml
lines=2 # and that a point lies beyond the test
refuse "fit: 3 parameters cannot be told from 2 points; fit fewer, or measure more" calibrate fit.yaml --against points.csv

lines=1

for verb in material calibrate; do
  refuse "breccia $verb: --picture: 'a.txt' should end in .png, .svg or .pdf" $verb stage.yaml --picture a.txt
done

# ---- results ----
cp base.yaml done.yaml
"$breccia" run done.yaml --quiet > out 2>&1 || fail "run: $(cat out)"
refuse "field 'displacement' has 3 components and none called 'xx'" plot done --field displacement --component xx
refuse "field 'stress' has 6 components; choose one, like xx" plot done --field stress
refuse "there is no field 'strain'" plot done --field strain

# ---- motions ----
printf 'time (s),x (g)\n0,0\n0.1,1\n' > motion.csv
refuse "periods: 100001 of them; ask for 1 to 100000" spectrum motion.csv --column x --count 100001
printf 'time (s),x (g)\n0,0\n' > motion.csv
refuse "holds 1 rows of numbers; a history needs two at least" spectrum motion.csv --column x
printf 'time (s),x (g)\n0,0\n0.1,nan\n' > motion.csv
refuse "row 2 of its numbers lacks a time or a value" spectrum motion.csv --column x
printf 'time (furlong),x (g)\n0,0\n0.1,1\n' > motion.csv
refuse "has no unit of time" spectrum motion.csv --column x

# ---- studies ----
refuse "--vary solve.explicit.steps: a value is empty" study base.yaml --vary "solve.explicit.steps=1,,2"
refuse "should be like" study base.yaml --vary "solve.explicit.steps=1,2" --result "peak nothing"
finish

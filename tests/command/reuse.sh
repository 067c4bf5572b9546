# Decks that reuse: variables, included files, settings from the command line, and what is written of them.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
mkdir library
cat > library/materials.yaml <<'Y'
materials: {include: stone.yaml}
Y
cat > library/stone.yaml <<'Y'
rock: {model: elastic, density: 2400 kg/m3, Young modulus: "${E}", Poisson ratio: 0.2}
sand: {model: elastic, density: 1.6 t/m3, Young modulus: 20 MPa, Poisson ratio: 0.3}
Y
cat > block.yaml <<'Y'
title: Block of ${n} particles across
include: library/materials.yaml
variables: {n: 4, width: 0.2 m, dx: "${width/n}", E: 30 GPa}
materials: {rock: {density: 2500 kg/m3}}
body: {block: &block {material: rock, spacing: '${dx}', shape: {box: {from: [0, 0, 0], to: [${2*width}, ${width}, ${max(dx, 10 cm)}]}}}}
selections: {end: {face: x+}}
loads:
  - {name: pull, on: end, velocity: [0.1 m/s, free, free]}
  - {on: {face: x-}, displacement: [0, free, free]}
solve: {explicit: {end time: 0.2 ms}}
watch: {end: {displacement of: end}}
Y
cat > plain.yaml <<'Y'
title: Block of 4 particles across
materials:
  rock: {model: elastic, density: 2500 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}
  sand: {model: elastic, density: 1600 kg/m3, Young modulus: 20 MPa, Poisson ratio: 0.3}
body: {block: {material: rock, spacing: 50 mm, shape: {box: {from: [0, 0, 0], to: [0.4, 0.2, 0.1]}}}}
selections: {end: {face: x+}}
loads:
  - {name: pull, on: end, velocity: [0.1 m/s, free, free]}
  - {on: {face: x-}, displacement: [0, free, free]}
solve: {explicit: {end time: 0.2 ms}}
watch: {end: {displacement of: end}}
Y
"$breccia" run block.yaml --quiet || fail "block.yaml does not run"
"$breccia" run plain.yaml --quiet || fail "plain.yaml does not run"
"$breccia" run block/deck.yaml --quiet --output again || fail "block/deck.yaml does not run"
cmp block/end.csv plain/end.csv || fail "the deck with variables moves otherwise than the one without"
cmp block/end.csv again/end.csv || fail "the deck that was written moves otherwise than the one that was run"
equal "deck written again" "$(sed 1,2d again/deck.yaml)" "$(sed 1,2d block/deck.yaml)"
contains "summary" "$(cat block/summary.json)" '"variables": {"n": "4", "width": "0.2 m", "dx": "0.05 m", "E": "30 GPa"}'

# Settings: the same as another deck; written down in summary and deck; a restart is told.
"$breccia" run plain.yaml --quiet --output set --set 'body.block.spacing=25 mm' --set "loads.pull.velocity=[0.2 m/s, free, free]" --set loads.2.displacement='[0, 0, free]'
sed 's/50 mm/25 mm/; s/0.1 m\/s/0.2 m\/s/; s/\[0, free, free\]/[0, 0, free]/' plain.yaml > other.yaml
"$breccia" run other.yaml --quiet
cmp set/end.csv other/end.csv || fail "settings give another run than the deck with these values"
contains "settings in the summary" "$(cat set/summary.json)" '"settings": ["body.block.spacing=25 mm", "loads.pull.velocity=[0.2 m/s, free, free]", "loads.2.displacement=[0, 0, free]"]'
contains "settings in the deck" "$(head -1 set/deck.yaml)" '--set "body.block.spacing=25 mm"'
contains "variable set" "$("$breccia" check block.yaml --set variables.n=8)" 'Block of 8 particles across: 512 particles'
"$breccia" run plain.yaml --quiet --output set --set 'body.block.spacing=25 mm' --restart 2> errors && fail "another deck goes on from a checkpoint"
contains "restart of another deck" "$(cat errors)" 'was written with another deck'

# Many names, half of them from a file: settings and expressions find each of them.
for n in $(seq 1 30); do echo "theirs$n: $n"; done > many.yaml
{
  sed 's/^title: .*/title: Sum ${own1 + own30 + theirs1 + theirs29 + theirs30}/' plain.yaml
  echo 'variables:'
  for n in $(seq 1 30); do echo "  own$n: $n"; done
  echo '  include: many.yaml'
} > names.yaml
contains "many names" "$("$breccia" check names.yaml)" 'Sum 91:'
contains "many names, two of them set" "$("$breccia" check names.yaml --set variables.theirs29=129 --set variables.own30=1030)" 'Sum 1191:'

# A key with a point in it is not the shorter one before the point, whichever stands first.
for names in "rock rock.1" "rock.1 rock"; do
  for name in $names; do echo "  $name: {model: elastic, density: 2500 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}"; done > rocks
  sed '/^  sand/d; /^  rock/ {r rocks
d}' plain.yaml > rocks.yaml
  contains "density of $names" "$("$breccia" check rocks.yaml --set materials.rock.1.density=1700 2>&1)" "rock.1: 1700 kg/m3"
  contains "density of $names" "$("$breccia" check rocks.yaml --set materials.rock.1.density=1700 --set materials.rock.density=1900 2>&1)" "rock: 1900 kg/m3"
done

# refuse FILE EDIT WORDS: FILE after a sed edit makes block.yaml, or what it is, refused in these words, all of them
refuse() {
  cp -r library kept
  cp block.yaml kept.yaml
  sed -i "$2" "$1"
  cmp -s "$1" "kept${1#library}" && fail "the edit $2 changes nothing"
  "$breccia" check block.yaml > out 2> errors
  equal "$2: exit status" $? 2
  equal "$2" "$(cat errors)" "$3"
  rm -r library
  mv kept library
  mv kept.yaml block.yaml
}
refuse library/stone.yaml 's/20 MPa/20 MN/' "library/stone.yaml:2:58: Young modulus: '20 MN' has the wrong dimension; an area is left over; expected a stress, like '1.5 kPa' or 1.5 (plain numbers are in Pa)"
refuse library/stone.yaml 's/density/densty/' "library/stone.yaml:1:24: material: unknown key 'densty'; did you mean 'density'?
library/stone.yaml:2:24: material: unknown key 'densty'; did you mean 'density'?"
refuse library/stone.yaml 's/{E}/{G}/' "library/stone.yaml:1:63: Young modulus: there is no variable 'G'; the deck's variables are n, width, dx, E"
refuse library/stone.yaml '1s/$/}/' "library/stone.yaml:1:87: not valid YAML: flow mapping with invalid extra closing brace"
refuse library/stone.yaml '1i include: materials.yaml' "library/stone.yaml:1:10: include: library/materials.yaml: includes itself by way of other files"
refuse library/materials.yaml 's/stone/stones/' "library/materials.yaml:1:22: include: library/stones.yaml: No such file or directory"
refuse library/materials.yaml 's/stone.yaml/../' "library/materials.yaml:1:22: include: library/..: is not a file of at most 64 MB"
refuse block.yaml 's/include: .*/include: block.yaml/' "block.yaml:2:10: include: block.yaml: includes itself"
refuse block.yaml 's/include: .*/include: {a: 1}/' "block.yaml:2:1: include: expected the name of a file, or a list of names"
refuse block.yaml 's/{2\*width}/{2.01*width}/' "block.yaml:5:65: box: its size along x, 0.402, is not a whole number of spacings of 0.05 (it is 8.04 of them); a spacing of 0.05025 fits"
refuse block.yaml 's/0.1 m\/s/${width}/' "block.yaml:8:38: velocity: '0.2 m' has the wrong dimension; a time is left over; expected a velocity, like '1.5 m/s' or 1.5 (plain numbers are in m/s) (written '\${width}')"
refuse block.yaml 's/dx, 10 cm/dx, n/' "block.yaml:5:117: a length and a plain number cannot be compared; give every quantity its unit"
finish

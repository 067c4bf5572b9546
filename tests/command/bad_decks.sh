# Wrong decks: each is the good one with a change, and must be refused in one line with place, reason and advice.
. "$(dirname "$0")/common.sh"

cat > "$work/good.yaml" <<'Y'
title: A good deck
units: {length: m, force: kN, time: s}
materials:
  clay: {model: multi-yield-j2, density: 1.5, shear modulus: 60 MPa, bulk modulus: 100 MPa, octahedral strength: 30}
  steel: {model: elastic, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3}
body:
  plate:
    material: clay
    spacing: 0.1
    shape: {box: {from: [0, 0, 0], to: [1, 0.5, 0.3]}}
selections:
  end: {face: x+, layers: 2}
cracks:
  - {cut: {line: [[0.45, 0], [0.45, 0.2]]}}
peridynamics: {horizon: 3.015 spacings}
failure: {critical stretch: 0.05}
loads:
  - {name: pull, on: end, body force: [1, 0, 0], history: {ramp to: 1 ms}}
solve: {explicit: {steps: 10}}
watch:
  tip: {displacement of: end}
results: {fields: [displacement, damage]}
pictures:
  - {field: damage}
Y

"$breccia" check "$work/good.yaml" > "$work/out" 2>&1 || fail "the good deck is refused: $(cat "$work/out")"

# refuse EDIT PLACE WORDS (under the sanitizers every fifth; they see all kinds of decks in the fuzzer too): the good deck after a sed edit is refused at line:column with these words
refuse() {
  left_out 5 && return
  sed "$1" "$work/good.yaml" > "$work/deck.yaml"
  cmp -s "$work/good.yaml" "$work/deck.yaml" && fail "the edit $1 changes nothing"
  (cd "$work" && timeout 120 "$breccia" run deck.yaml > out 2> errors)
  equal "$1: exit status" $? 2
  contains "$1" "$(cat "$work/errors")" "deck.yaml:${2:+$2: }"
  contains "$1" "$(cat "$work/errors")" "$3"
  grep -q '(null)' "$work/errors" && fail "$1: $(cat "$work/errors")"
  equal "$1: lines" "$(wc -l < "$work/errors")" 1
  [ -e "$work/deck" ] && fail "$1: something was written"
  [ -s "$work/out" ] && fail "$1: something was printed: $(cat "$work/out")"
}

refuse 's/{field: damage}$/{field: damage, inside: {union: [{sphere: {centre: [0, 0, 0], radius: 1}}, {box: {particles: [2, 2, 2]}}]}}/' 24:21 "no lattice tells the size of 'particles'"
refuse 's/{field: damage}$/{curve: "tip.x : tip.y", inside: {sphere: {centre: [0, 0, 0], radius: 1}}}/' 24:30 'inside: a curve of histories has no use for it; leave it out'
refuse 's/spacing: 0.1$/spacing: 3 s/' 9:14 "has the wrong dimension; expected a length, like '1.5 m'"
refuse 's/spacing: 0.1$/spacing: 0.1 parsec m/' 9:14 "has the wrong dimension"
refuse 's/^title: .*/&\nvariables: {W: 0.1 m}/; s/spacing: 0.1$/spacing: "${W}^2"/' 10:15 "'0.01 m2' has the wrong dimension; a length is left over; expected a length"
refuse 's/spacing: 0.1$/spacing: "${sin(1 m)}"/' 9:17 "sin takes an angle, like sin(30 deg), or a plain number in radians, not a length"
printf 'a\nb\nACCELERATION IN UNITS OF FURLONGS\nNPTS= 2, DT= 1.00D-02 SEC\n0 1\n' > "$work/motion.AT2"
refuse 's/ramp to: 1 ms/file: {name: motion.AT2}/' 18:73 "motion.AT2:3: the unit 'FURLONGS' is unknown; expected g, cm/s2"
printf '0\n1\n2\n' > "$work/values.txt"
refuse 's/ramp to: 1 ms/file: {name: values.txt}/' 18:73 "values.txt:1: holds values without times, found '0'; give the step between them ('time step' in a deck"
refuse 's/spacing: 0.1$/spacing: 0.1 smoots/' 9:14 "unit 'smoots' is not known"
refuse 's/spacing: 0.1$/spacing: -0.1/' 9:14 'is out of range; it must be greater than 0'
refuse 's/spacing: 0.1$/spacing: wide/' 9:14 'is not a number'
refuse 's/spacing: 0.1$/spacing: [1]/' 9:5 'expected a number, found a list'
refuse 's/spacing: 0.1$/spacing: 0.3/' 10:13 'is not a whole number of spacings of 0.3'
refuse 's/spacing: 0.1$/spacing: 0.0001/' 9:14 'more than the 2e9'
refuse 's/horizon: 3.015 spacings/horizons: 3/' 15:16 "unknown key 'horizons'; did you mean 'horizon'?"
refuse 's/    spacing: 0.1$//' 7:3 "missing key 'spacing'"
refuse 's/    spacing: 0.1$/    spacing: 0.1\n    spacing: 0.1/' 10:5 "key 'spacing' stands here twice (first in line 9)"
refuse 's/material: clay/material: sand/' 8:15 "there is no material 'sand'; the deck defines 'clay', 'steel'"
refuse 's/  steel:/  clay:/' 5:3 "'clay' is defined twice (first in line 4)"
refuse 's/multi-yield-j2/multi-yeld-j2/' 4:17 "there is no model 'multi-yeld-j2'; did you mean 'multi-yield-j2'?"
refuse 's/shear modulus/shear modulas/' 4:47 "unknown key 'shear modulas'; did you mean 'shear modulus'?"
refuse 's/octahedral strength: 30/octahedral strength: 7 MPa/' 4:3 'a hyperbola cannot pass through both'
refuse 's/octahedral strength: 30/surfaces: 20/' 4:3 "give either 'octahedral strength' or 'cohesion'"
refuse 's/Poisson ratio: 0.3/Poisson ratio: 0.5/' 5:81 'it must be greater than -1 and less than 0.5'
refuse 's/Poisson ratio: 0.3/bulk modulus: 1/' 5:3 "give 'Young modulus' and 'Poisson ratio'"
refuse 's/density: 1.5/density: 1.5 ton\/m3/' 4:42 "'ton' may be short, long or metric"
refuse 's/length: m/length: kN/' 2:1 'is not a unit of length'
refuse 's/to: \[1, 0.5, 0.3\]/to: [-1, 0.5, 0.3]/' 10:13 "'to' must lie beyond 'from'"
refuse 's/to: \[1, 0.5, 0.3\]/to: [1]/' 10:36 'expected a list of 2 or 3 numbers'
refuse 's/, to: \[1, 0.5, 0.3\]//' 10:13 "give either 'from' and 'to', or 'particles'"
refuse 's/shape: {box/shape: {bax/' 10:13 "unknown key 'bax'; did you mean 'box'?"
refuse 's/face: x+/face: east/' 12:15 "'east' is not known; choose from x-, x+, y-, y+, z-, z+"
refuse 's/layers: 2/layers: 0/' 12:27 'it must be at least 1'
refuse 's/layers: 2/layers: 1.5/' 12:27 'is not a whole number'
refuse 's/{face: x+, layers: 2}/{layers: 2}/' 12:3 'say what is selected'
refuse 's/face: x+/block: dam/' 12:16 "there is no block 'dam'"
refuse 's/on: end/on: edn/' 18:22 "there is no selection 'edn'; did you mean 'end'? (the deck defines 'end')"
refuse 's/on: end/on: {nearest: [0, 0, 0], face: x+}/' 18:18 'the selection holds no particle'
refuse 's/on: end/on: {group: edn}/' 18:30 "there is no selection 'edn'; did you mean 'end'?"
refuse 's/on: end/on: {except: {all: yes}}/' 18:18 "the selection holds no particle; 'except' leaves none of the 150 that its other keys select"
refuse 's/on: end/on: {all of: [end, {face: x-}]}/' 18:18 "'all of' leaves none of the 150"
refuse 's/on: end/on: {any of: [end, {nearest: [0, 0, 0], face: x+}]}/' 18:38 'the selection holds no particle; particles stand at'
refuse 's/on: end/on: {any of: []}/' 18:23 'any of: expected a name, keys and values, or a list of such; found an empty list'
refuse 's/on: end/on: {union: [end]}/' 18:23 "unknown key 'union'; did you mean 'any of'?"
refuse 's/end: {face: x+, layers: 2}/end: {any of: [end, {face: x-}]}/' 12:18 "the selection 'end' is made of itself"
refuse 's/    spacing: 0.1$/    spacing: 0.1\n    lattice: fcc/' 10:14 "'fcc' is not known; did you mean 'face-centred cubic'?"
refuse 's/body force: \[1, 0, 0\]/body force: [1, 0, 0], force: [1, 0, 0]/' 18:50 "more than one of"
refuse 's/body force: \[1, 0, 0\], //' 18:6 "none of 'body force', 'force'"
refuse 's/body force: \[1, 0, 0\]/body force: [1 kN, 0, 0]/' 18:40 'wrong dimension; a volume is left over; expected a force per volume'
refuse 's/ramp to: 1 ms/table: [[0, 0], [1, 1], [1, 2]]/' 18:85 'times must grow'
refuse 's/horizon: 3.015 spacings/horizon: 0.05/' 15:25 'so that no particle has a neighbour'
refuse 's/horizon: 3.015 spacings/space: plane stress/' 15:23 'needs a square or hexagonal lattice'
refuse 's/horizon: 3.015 spacings/zero-energy control: {silling: 0.1, wan: 0.1}/' 15:57 'more than one of'
refuse 's/horizon: 3.015 spacings/influence: gausian/' 15:27 "did you mean 'gaussian'?"
refuse 's/stretch: 0.05/stretch: 0/' 16:29 'it must be greater than 0'
refuse 's/steps: 10/steps: 10, end time: 1 s/' 19:41 'more than one of'
refuse 's/steps: 10/steps: 10, time step: 1 s/' 19:42 'times the stable step'
refuse 's/steps: 10/steps: 10, damping: 120 Hz/' 19:40 "damping: '120 Hz' is a frequency, but a rate is asked, like '30 1/s'; a ratio of critical damping at a frequency is written {ratio: 0.05, at: 120 Hz}"
refuse 's/steps: 10/steps: 10, damping: 2 kPa/' 19:40 "expected a damping rate, like '1.5 1/s'"
refuse 's/steps: 10/steps: 10, damping: {ratio: 0.05}/' 19:31 "damping: missing key 'at'"
refuse 's/displacement of: end/displacment of: end/' 21:9 "unknown key 'displacment of'; did you mean 'displacement of'?"
refuse 's/displacement of: end/load: push/' 21:15 "there is no load 'push'; the deck defines 'pull'"
refuse 's/displacement of: end/reaction of: push/' 21:22 "there is no load 'push'; the deck defines 'pull'"
# one mistake, one line: what uses names whose definitions are wrongly written is not wrong
refuse 's/^selections:/selection:/' 11:1 "unknown key 'selection'; did you mean 'selections'?"
refuse 's/^loads:/load:/; s/displacement of: end/load: pull/' 17:1 "unknown key 'load'; did you mean 'loads'?"
refuse 's/name: pull/nam: pull/; s/displacement of: end/reaction of: pull/' 18:6 "unknown key 'nam'; did you mean 'name'?"
refuse 's/displacement of: end/opening between: [[0, 0, 0], [0, 0, 0]]/' 21:9 'the same particle is nearest to both points'
refuse 's/displacement of: end/bond between: [[0, 0, 0], [1, 0, 0]]/' 21:9 'no bond joins'
refuse 's/displacement, damage/displacement, colour/' 22:34 "there is no field 'colour'; the fields are displacement"
refuse 's/field: damage/field: pressure/' 24:13 "there is no field 'pressure'"
refuse 's/line: \[\[0.45, 0\], \[0.45, 0.2\]\]/line: [[0.45, 0]]/' 14:12 'needs at least two points'
refuse 's/cut: {line: \[\[0.45, 0\], \[0.45, 0.2\]\]}/remove: {sphere: {centre: [0, 0, 0], radius: 9}}/' 10:5 'no lattice cell has its centre inside'
refuse 's/^solve: .*/solve: {explicitt: {steps: 1}}/' 19:9 "unknown key 'explicitt'; did you mean 'explicit'?"
refuse 's/^solve: .*//' 1:1 "missing key 'solve'"
refuse 's/^title: .*/title: [/' '' 'not valid YAML'
refuse 's/^title: .*/title: *other/' 1:8 "there is no anchor '&other' before the alias '*other'"

refuse 's/    spacing: 0.1$/    spacing: 0.1\n    lattice: square\n    thickness: 1/; s/\[1, 0, 0\]/[1, 0, 2]/; s/^peri.*/peridynamics: {space: plane strain}/' \
  20:27 'has a part along z, but the body is plane'

refuse 's/  tip: .*/  tip: {history of: end}/; s/material: clay/material: steel/' 21:21 'history of: elastic has no named history'
refuse 's/  tip: .*/  tip: {history of: {face: z-}}/; s/^selections:/  foot: {material: steel, spacing: 0.1, shape: {box: {particles: [3, 5, 3], first particle: [1.05, 0.05, 0.05]}}}\nselections:/' \
  22:9 'history of: the particles are of several materials'

# Ordinary peridynamics knows no strain of a law
ordinary='s/horizon: 3.015 spacings/formulation: ordinary/'
refuse "$ordinary" 4:17 "material 'clay': 'multi-yield-j2' needs a strain, which ordinary does not have; it takes elastic, j2, viscoelastic"
refuse "$ordinary; s/  clay: .*/  clay: {model: j2, density: 1.5, Young modulus: 60 MPa, Poisson ratio: 0.3, yield stress: 50, hardening modulus: 1 MPa}/" \
  4:3 "material 'clay': ordinary: families yield without hardening: leave out"
refuse "$ordinary; s/  clay: .*/  clay: {model: elastic-1d, density: 1.5, Young modulus: 60 MPa}/" 4:17 "'elastic-1d' is a law of one strain; ordinary takes"
refuse "$ordinary; s/ordinary}/ordinary, lattice weights: even}/" 15:56 "lattice weights: 'even' is not known; choose from isotropic, plain"
refuse "$ordinary; s/  clay: .*/  clay: {model: elastic, density: 1.5, Young modulus: 60 MPa, Poisson ratio: 0.3}/; s/    spacing: 0.1\$/    spacing: 0.1\n    lattice: line\n    area: 1/; s/^peri.*/peridynamics: {formulation: ordinary, space: 1-D}/" \
  17:29 'formulation: ordinary has no deviator along a line; bars take bond-based'

# Words of other programs and of notes, and keys in the wrong section
refuse 's/Young modulus/E/' 5:42 "unknown key 'E'; did you mean 'Young modulus'?"
refuse 's/Poisson ratio/nu/' 5:66 "unknown key 'nu'; did you mean 'Poisson ratio'?"
refuse 's/density: 7.85/rho: 7.85/' 5:27 "unknown key 'rho'; did you mean 'density'?"
refuse 's/Young modulus/Young/' 5:42 "unknown key 'Young'; did you mean 'Young modulus'?"
refuse 's/model: elastic/type: elastic/' 5:11 "unknown key 'type'; did you mean 'model'?"
refuse 's/model: elastic, //' 5:3 "none of 'model', 'opensees', 'remote' is given; give exactly one"
refuse 's/model: elastic/model: von mises/' 5:18 "did you mean 'j2'? (J2 plasticity is that of von Mises)"
refuse 's/field: damage/field: von mises/' 24:13 "did you mean 'von Mises stress'?"
refuse 's/field: damage/field: stress, component: 11/' 24:32 "component: stress has no '11'; did you mean 'xx'?"
refuse 's/field: damage/field: stress/' 24:13 "field: stress is drawn by 'component'; its components are xx, yy, zz, xy, yz, zx"
refuse 's/field: damage/field: damage, component: x/' 24:32 "component: damage has no 'x'; it is one number, leave 'component' out"
refuse 's/, history: {ramp to: 1 ms}/, ramp: 0.1 s/' 18:50 "unknown key 'ramp'; 'ramp to' stands under 'history', like history: {ramp to: ...}"
refuse 's/{face: x+, layers: 2}/{box: {from: [0, 0, 0], to: [1, 1, 1]}}/' 12:9 "'box' stands under 'inside', like inside: {box: ...}"
refuse 's/{explicit: {steps: 10}}/{steps: 10}/' 19:9 "unknown key 'steps'; 'steps' stands under 'explicit'"
refuse 's/{explicit: {steps: 10}}/{static: {quasi-static: {}}}/' 19:18 "static: unknown key 'quasi-static'; 'quasi-static' stands under 'explicit'; the keys here are"
refuse 's/body force: \[1, 0, 0\]/fix: [x]/' 18:27 "did you mean 'displacement'? (0 holds a direction and 'free' leaves it"
refuse 's/body force: \[1, 0, 0\]/displacement: [0, fixed]/' 18:45 "expected a number or 'free', found 'fixed'"
refuse 's/^body:/geometry:/' 6:1 "unknown key 'geometry'; did you mean 'body'?"
refuse 's/face: x+/face: right/' 12:15 "did you mean 'x+'?"
refuse 's/ramp to: 1 ms/table: motion.csv/' 18:67 'like [[0, 0], [0.1 s, 1]]; found motion.csv: files are not read here, write the rows out'

# Numbers and units as they are written elsewhere
refuse 's/spacing: 0.1$/spacing: 0,1/' 9:14 "'0,1': write decimals with a point"
refuse 's/210 GPa/210 000 MPa/' 5:57 "'210 000 MPa': write thousands with nothing between"
refuse 's/210 GPa/2.1x10^5 MPa/' 5:57 "write powers of ten like 3e4"
refuse 's/210 GPa/210 Gpa/' 5:57 "'Gpa' is not a unit of stress; did you mean 'GPa'?"
refuse 's/210 GPa/210000 KN\/M2/' 5:57 "did you mean 'kN/m2'?"
refuse 's/210 GPa/30e6 lb\/in2/' 5:57 "'lb/in2' is not a unit of stress; did you mean 'lbf/in2'?"
refuse 's/210 GPa//' 5:42 "no value is given; expected a stress"
refuse 's/density: 7.85/density: 77 kN\/m3/' 5:36 "'77 kN/m3' is a weight per volume; the density is its mass, 7851.8 kg/m3"
refuse 's/horizon: 3.015 spacings/horizon: 3.015/' 15:25 "horizon: did you mean '3.015 spacings'? A plain number is a length, and this one is 30.1 spacings of 0.1"
refuse 's/horizon: 3.015 spacings/horizon: 3.015 dx/' 15:25 "did you mean '3.015 spacings'?"
refuse 's/^units: .*/units: SI/' 2:8 'units: expected keys and values, like {length: m, force: N, time: s}; found SI'
refuse 's/spacing: 0.1$/spacing: 2/' 10:13 'its size along x, 1, is less than one spacing of 2'
refuse 's/face: x+, layers: 2/inside: {box: {from: [3, 0, 0], to: [4, 1, 1]}}/' 12:3 "the selection 'end' holds no particle; particles stand at x from 0.05 to 0.95, y from 0.05 to 0.45, z from 0.05 to 0.25; the one nearest to the middle of the shape is at [0.95, 0.45, 0.25]"

refuse 's/ramp to: 1 ms/sine: {frequency: 2 s}/' 18:78 "'2 s' has the wrong dimension; expected a frequency"
refuse 's/density: 7.85/density: 7.85 gr\/cm3/' 5:36 "'gr' is a grain of 65 mg to some; write g"
refuse 's/horizon: 3.015 spacings/horizon: 3,015 spacings/' 15:27 'inside { } a comma parts items: write decimals with a point'
refuse 's/on: end/on: [end, end]/' 18:18 'on: expected one name, or keys and values; found a list'
refuse 's/horizon: 3.015 spacings/horizon: 300/' 15:25 'horizon: 300 reaches over 3e+03 spacings of 0.1; 3 to 4 are usual'
refuse 's/{box: {from/{cuboid: {from/' 10:13 "unknown key 'cuboid'; did you mean 'box'?"

# Curves of columns that no history writes
refuse 's/{field: damage}/{curve: "tap.x : tip.y"}/' 24:14 "there is no history 'tap'; did you mean 'tip'?"
refuse 's/{field: damage}/{curve: "tip.x : tip.force"}/' 24:14 "curve: tip: there is no column 'force'; its columns are step, time, x, y, z"
refuse 's/{field: damage}/{curve: "time : tip.x, tip.y"}/' 24:14 "; each history has its time: 'tip.time : tip.x, tip.y'"
refuse 's/{field: damage}/{curve: "-tip.x:step"}/' 24:14 "; each history has its step: '-tip.x : tip.step'"
refuse 's/{field: damage}/{curve: "tip.x , tip.y"}/' 24:14 "should be 'watch.column : watch.column'"

# Unknown names are told all at once, each at its own place, with wrong keys or with what else is wrong
cat > "$work/names.yaml" <<'Y'
title: Names
materials: {rock: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {wall: {material: rok, spacing: 0.1 m, shape: {box: {from: [0, 0, 0], to: [1 m, 1 m, 1 m]}}}}
selections: {top: {face: z+, block: wal}}
loads: [{name: push, on: topp, force: [0, 0, 1 N]}, {on: {block: hall}, force: [0, 0, 1 N]}]
solve: {explicit: {steps: 1}}
watch: {a: {displacement of: botom}, b: {load: pull}}
results: {fields: [damage, damag, colour]}
Y
cat > "$work/wanted" <<'Y'
names.yaml:3:25: there is no material 'rok'; did you mean 'rock'? (the deck defines 'rock')
names.yaml:4:37: there is no block 'wal'; did you mean 'wall'? (the deck defines 'wall')
names.yaml:5:26: there is no selection 'topp'; did you mean 'top'? (the deck defines 'top')
names.yaml:5:66: there is no block 'hall'; did you mean 'wall'? (the deck defines 'wall')
names.yaml:7:30: there is no selection 'botom'; the deck defines 'top'
names.yaml:7:48: there is no load 'pull'; the deck defines 'push'
names.yaml:8:28: there is no field 'damag'; did you mean 'damage'?
names.yaml:8:35: there is no field 'colour'; the fields are displacement
Y
(cd "$work" && "$breccia" check names.yaml 2>&1 | sed 's/\(are displacement\),.*/\1/') > "$work/out"
equal "all unknown names" "$(cat "$work/out")" "$(cat "$work/wanted")"
sed -i 's/title:/titel:/; s/spacing:/spacin:/' "$work/names.yaml"
(cd "$work" && "$breccia" check names.yaml > out 2>&1)
equal "names beside wrong keys" "$(grep -c 'there is no' "$work/out") $(grep -c 'unknown key' "$work/out")" "6 2"
refuse 's/displacement of: end/load: pul/; s/{field: damage}/{curve: "tip.value : tip.factor"}/' 21:15 "there is no load 'pul'; did you mean 'pull'?"
sed 's/table: .*//; s/ramp to: 1 ms/table: ['"$(for k in $(seq 40); do printf '[%d, x%d], ' $k $k; done)"'[50, 1]]/' "$work/good.yaml" > "$work/deck.yaml"
(cd "$work" && "$breccia" check deck.yaml > out 2>&1)
equal "forty wrong numbers" "$(wc -l < "$work/out") $(tail -1 "$work/out")" "31 and more, which are told when these are mended"

# YAML that is none
refuse 's/^    spacing/\tspacing/' 9:2 'indent with blanks, not with tabs'
refuse 's/^    spacing/   spacing/' 9:4 'keys that belong together must begin in the same column'
refuse 's/    spacing: 0.1$/    spacing:0.1/' 9:5 "a key ends with a colon and a blank, like 'spacing: 10'"
refuse 's/^title: .*/title: A beam: three points/' 1:14 "words that hold ': ' must stand in quotation marks"

bars='s/^  clay: .*/  clay: {model: elastic-1d, density: 1, Young modulus: 1 GPa}/; s/^  steel: .*/  steel: {model: elastic-1d, density: 1, Young modulus: 2 GPa}/'
refuse "$bars; s/{model: elastic-1d, density: 1, Young modulus: 1 GPa}/{model: elastic, density: 1, bulk modulus: 1 GPa, shear modulus: 1 GPa}/; s/^peri.*/peridynamics: {formulation: bond-based}/" \
  4:17 "'elastic' is a law of strain in space; bond-based takes elastic-1d"
refuse 's/model: elastic, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3/model: elastic-1d, density: 7.85, Young modulus: 210 GPa/' \
  5:18 "'elastic-1d' is a law of one strain; correspondence takes elastic, j2"
refuse 's/critical stretch: 0.05/critical stretch: 0.05, fracture energy: 100 N\/m/' 16:52 "give 'critical stretch' or 'fracture energy', not both"
refuse 's/critical stretch: 0.05/fracture energy: 100 N\/m/' 16:28 'no critical stretch follows from it in correspondence'
refuse 's/critical stretch: 0.05/criterion: critical bond energy/' 16:22 "give 'bond energy' or 'fracture energy'"
refuse 's/critical stretch: 0.05/criterion: critical bond energy, bond energy: 1 kJ\/m6, fracture energy: 100 N\/m/' 16:57 "give 'bond energy' or 'fracture energy', not both"
refuse 's/critical stretch: 0.05/criterion: critical bond energy, bond energy: 1 kJ\/m3/' 16:57 'expected a bond energy'
refuse 's/critical stretch: 0.05/criterion: critical bond energy, critical stretch: 0.05/' 16:44 'critical stretch: is for critical stretch'
refuse 's/critical stretch: 0.05/criterion: critical energy, bond energy: 1 kJ\/m6/' 16:22 "did you mean 'critical bond energy'"
refuse "$bars; s/{model: elastic-1d, density: 1, Young modulus: 1 GPa}/{model: elastic-brittle, density: 1, Young modulus: 1 GPa, fracture energy: 100 N\\/m}/; s/^peri.*/peridynamics: {formulation: bond-based}/; s/critical stretch: 0.05/criterion: critical bond energy, bond energy: 1 kJ\\/m6/" \
  16:22 "'elastic-brittle' of material 'clay' says by itself what bonds carry"
refuse "$bars; s/^peri.*/peridynamics: {formulation: bond-based, zero-energy control: {none: yes}}/" 15:41 'zero-energy control: is for correspondence'
refuse "$bars; s/^peri.*/peridynamics: {formulation: bond-based, calibration: elastic}/" 15:54 "calibration: 'elastic' is not known; choose from continuum, uniform-expansion, uniaxial"
refuse "$bars; s/^peri.*/peridynamics: {formulation: bond-based, strain: small}/" 15:41 'strain: is for correspondence, hybrid; bond-based does not have it: leave it out'
refuse 's/^peri.*/peridynamics: {strian: small}/' 15:16 "unknown key 'strian'; did you mean 'strain'?"
refuse 's/^peri.*/peridynamics: {formulation: bonds, strian: small}/' 15:29 "formulation: 'bonds' is not known"
refuse 's/^peri.*/peridynamics: {surface correction: energy}/' 15:16 'surface correction: is for bond-based; correspondence does not have it: leave it out'
refuse 's/model: elastic, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3/model: elastic-brittle, density: 7.85, Young modulus: 210 GPa, fracture energy: 1 N\/m/' \
  5:18 "'elastic-brittle' is a law of one strain; correspondence takes elastic, j2"
refuse 's/model: elastic, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3/model: j2, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3, yield stress: 400 MPa, largest strain: 0.1/' \
  5:3 "material 'steel' (j2): 'smallest strain' and 'largest strain' are for laws of one strain"
refuse 's/model: elastic, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3/model: j2, density: 7.85, Young modulus: 210 GPa, Poisson ratio: 0.3, yield stress: 400 MPa, saturation stress: 300 MPa/' \
  5:3 "material 'steel' (j2): 'saturation stress' must not lie below 'yield stress'"
softening='model: bilinear-softening, density: 1, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N\/m'
refuse "$bars; s/^peri.*/peridynamics: {formulation: bond-based}/; s/{model: elastic-1d, density: 1, Young modulus: 1 GPa}/{$softening}/" \
  4:3 "material 'clay' (bilinear-softening): a length of 0.7236, over which the fracture energy is spread, stores more than this energy at the peak, so that the curve would snap back; it must be less than 2 E G_F / f_t^2 = 0.666667: take a finer spacing, if the units of these numbers are right (lengths are in m, stresses in kPa)"
refuse "$bars; s/^peri.*/peridynamics: {formulation: bond-based}/; s/{model: elastic-1d, density: 1, Young modulus: 1 GPa}/{model: elastic-brittle, density: 1, Young modulus: 1 GPa}/" \
  4:3 "give either 'tensile strength' or 'fracture energy'"

refuse 's/    spacing: 0.1$/    spacing: 0.1\n    lattice: square\n    thickness: 1/; s/shape: .*/shape: {cylinder: {from: [1, 1, -1], to: [1, 1, 1], radius: 0.5}}/; s/^peri.*/peridynamics: {space: plane strain}/' \
  '' "In the plane a cylinder is a strip; a disc is a 'sphere'"

# warns EDIT PLACE WORDS: the good deck after an edit is read, with a warning at line:column
warns() {
  left_out 5 && return
  sed "$1" "$work/good.yaml" > "$work/deck.yaml"
  cmp -s "$work/good.yaml" "$work/deck.yaml" && fail "the edit $1 changes nothing"
  (cd "$work" && "$breccia" check deck.yaml > out 2> errors)
  equal "$1: exit status" $? 0
  contains "$1" "$(cat "$work/errors")" "warning: deck.yaml:$2: $3"
  grep -q '(null)' "$work/errors" "$work/out" && fail "$1: $(cat "$work/errors" "$work/out")"
}
(cd "$work" && "$breccia" check good.yaml > out 2> errors)
equal "the good deck: warnings" "$(cat "$work/errors")" ""
warns 's/density: 7.85/density: 7850/' 5:36 "density: 7850 is 7.85e+06 kg/m3; materials like it have 100 kg/m3 to 25000 kg/m3; did you mean '7850 kg/m3'? In m, kN, s that is 7.85"
warns 's/^units.*//; s/210 GPa/210/' 5:57 "Young modulus: 210 is 210 Pa; materials like it have 10 kPa to 1 TPa; did you mean '210 GPa'? In m, N, s that is 2.1e+11"
sed 's/^units.*/units: {length: mm, force: N, time: s}/; s/density: 1.5,/density: 1.5e-9,/; s/density: 7.85/density: 2400/; s/0.1$/100/; s/\[1, 0.5, 0.3\]/[1000, 500, 300]/
  s/0.45/450/g; s/octahedral strength: 30/octahedral strength: 30 kPa/' "$work/good.yaml" > "$work/mm.yaml"
"$breccia" check "$work/mm.yaml" 2> "$work/errors" > /dev/null
contains "density of concrete in mm, N, s" "$(cat "$work/errors")" "density: 2400 is 2.4e+15 kg/m3; materials like it have 100 kg/m3 to 25000 kg/m3; did you mean '2400 kg/m3'? In mm, N, s that is 2.4e-09"
warns 's/  steel: .*/  concrete: {model: elastic, density: 2.4, Young modulus: 30 MPa, Poisson ratio: 0.2}/' 5:59 "Young modulus: 30 MPa; materials like it have 1 GPa to 200 GPa; did you mean '30 GPa'?"
mazars='{model: mazars, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, tensile strength: 3 MPa, fracture energy: 120 N\/m}'
sed "s/  steel: .*/  wall: $mazars/; s/^failure.*//; s/{field: damage}/{field: material damage}/" "$work/good.yaml" > "$work/deck.yaml"
"$breccia" check "$work/deck.yaml" 2> "$work/errors" > /dev/null
equal "softening without breakage: warnings" "$(cat "$work/errors")" ""
sed "s/  steel: .*/  wall: $mazars/" "$work/good.yaml" > "$work/deck.yaml"
"$breccia" check "$work/deck.yaml" 2> "$work/errors" > "$work/out"
equal "softening with breakage: warnings" "$(cat "$work/errors")" ""
contains "softening: brittleness" "$(cat "$work/out")" "fracture energy 120 J/m2, E G_F / f_t^2 400 mm (1.3 horizons)"
warns "s/  steel: .*/  wall: $(echo "$mazars" | sed 's/120/22/; s/3 MPa/1.4 MPa/')/" 5:126 "fracture energy: 22 N/m is little for concrete, which has 60 to 200 N/m"
warns 's/  steel: .*/  wall: {model: mohr-coulomb, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, cohesion: 10 GPa, friction angle: 30, tensile strength: 3 GPa}/' 5:144 "tensile strength: it is 0.1 of Young's modulus"
warns 's/body force: \[1, 0, 0\], history: {ramp to: 1 ms}/displacement: [0.01, free, free]/' 18:27 "displacement: the particles jump by 0.01 m in the first step; let it grow"
for law in 'model: elastic' 'model: j2, yield stress: 1 MPa'; do
  cat > "$work/rest.yaml" <<Y
title: A plate at rest
units: {length: m, force: kN, time: s}
materials: {s: {$law, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body: {b: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}}
peridynamics: {space: plane strain}
loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [1e-5, free]}]
solve: {static: {}}
Y
  "$breccia" check "$work/rest.yaml" 2> "$work/errors" > /dev/null
  case $law in
  *j2*) contains "$law: jump at rest" "$(cat "$work/errors")" "the particles jump by 1e-05 m" ;;
  *) equal "$law: no jump at rest" "$(cat "$work/errors")" "" ;;
  esac
done
warns 's/body force: \[1, 0, 0\]/displacement: [0.01, free, free]/' 18:6 "load: bonds may break at the grips, within a horizon"
warns 's/\[\[0.45, 0\], \[0.45, 0.2\]\]/[[450, 0], [450, 200]]/' 14:6 'crack: it cuts no bond; the outermost particles stand at [0.05, 0.05, 0.05] and [0.95, 0.45, 0.25]: look at its coordinates and their unit'
warns 's/{cut: .*/{remove: {box: {from: [450, 0, 0], to: [451, 200, 1]}}}/' 14:6 'crack: it takes out no particle; the outermost'
for word in hold break; do
  sed "s/body force: \[1, 0, 0\]/displacement: [0.01, free, free]/; s/stretch: 0.05/stretch: 0.05, near grips: $word/" "$work/good.yaml" > "$work/deck.yaml"
  "$breccia" check "$work/deck.yaml" 2> "$work/errors" > /dev/null
  equal "near grips: $word: warnings" "$(cat "$work/errors")" ""
done

# Contact, and blocks that a gap parts or that overlap. two GAP ASIDE KEYS: a deck of two blocks, the second so
# far above the first and to its right
two() {
  cat > "$work/two.yaml" <<Y
title: Two blocks
units: {length: m, force: kN, time: s}
materials: {s: {model: elastic, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2}}
body:
  a: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}
  b: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [$2, $(awk "BEGIN {print 0.1 + $1}")], to: [$(awk "BEGIN {print 0.2 + $2}"), $(awk "BEGIN {print 0.2 + $1}")]}}}
peridynamics: {space: plane strain}
loads: [{on: {block: a}, body force: [0, 0]}]
$3
Y
  (cd "$work" && "$breccia" check two.yaml > out 2> errors)
  equal "two blocks, $*: status" $? 0
}
standard='solve: {explicit: {steps: 3}}'
two 0 0 "$standard"
equal "blocks that touch: warnings" "$(cat "$work/errors")" ""
two 0.01 0.01 "$standard"
equal "blocks that touch nearly: warnings" "$(cat "$work/errors")" ""
two 0.02 0 "$standard"
contains "blocks apart" "$(cat "$work/errors")" "warning: two.yaml:6:3: blocks 'a' and 'b' are 20 mm apart, within the horizon of 60.3 mm: bonded across the gap"
cp "$work/two.yaml" "$work/apart.yaml"
for to in 0.2 0.1; do
  awk -v to=$to '/^peridynamics/ {print "  c: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, 0.1], to: [" to ", 0.12]}}}"} 1' \
    "$work/apart.yaml" > "$work/filled.yaml"
  (cd "$work" && "$breccia" check filled.yaml > out 2> errors)
  equal "a third block in the gap, up to $to: status" $? 0
  equal "a third block in the gap, up to $to: warnings of it" "$(grep -c "bonded across the gap" "$work/errors")" "$([ $to = 0.2 ] && echo 0 || echo 1)"
done
for rows in 1 2; do
  cat > "$work/seam.yaml" << EOF
materials: {s: {model: elastic, density: 2 t/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}, w: {model: elastic, density: 2 t/m3, Young modulus: 3 GPa, Poisson ratio: 0.2}}
body:
  a: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}
  b: {material: w, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, 0.1], to: [0.2, $(echo "$rows" | awk '{print 0.1 + 0.02 * $1}')]}}}
  c: {material: s, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {from: [0, $(echo "$rows" | awk '{print 0.1 + 0.02 * $1}')], to: [0.2, 0.24]}}}
peridynamics: {space: plane stress, formulation: hybrid, horizon: 2.015 spacings}
solve: {explicit: {steps: 3}}
EOF
  (cd "$work" && "$breccia" check seam.yaml > out 2> errors)
  equal "a seam of $rows rows: status" $? 0
  equal "a seam of $rows rows: warnings" "$(grep -c "seam.yaml:4:3: block 'b' is thinner than the horizon, and its Young's modulus is 0.1 times another one: bonds between 'a' and 'c' reach across it and do not know its stiffness; give it 2 rows of particles or more across" "$work/errors")" "$((2 - rows))"
done
two 0.08 0 "$standard"
equal "blocks more than a horizon apart: warnings" "$(cat "$work/errors")" ""
two -0.05 0 "$standard"
contains "blocks that overlap" "$(cat "$work/errors")" "warning: two.yaml:6:3: blocks 'a' and 'b' overlap: 20 particles of the first stand inside the second, 20 of the second"
cut="$standard
cracks: [{cut: {line: [[-1, 0.11], [1, 0.11]]}}]"
two 0.02 0 "$cut
contact: {}"
contains "a cut in a gap" "$(cat "$work/errors")" "warning: two.yaml:10:11: crack: the cut lies in a gap of 20 mm, and contact takes cuts as closed"
contains "a line on contact" "$(cat "$work/out")" "contact: 1 times as stiff as the body, no friction"
two 0.02 0 "$cut"
equal "a cut in a gap without contact: warnings" "$(cat "$work/errors")" ""
two 0.0002 0 "$(echo "$cut" | sed 's/0.11/0.1001/g')
contact: {}"
equal "a cut between blocks that touch: warnings" "$(cat "$work/errors")" ""
two 0.02 0 "$standard
cracks: [{remove: {box: {from: [-1, 0.1], to: [1, 0.12]}}, cut faces: yes}]
contact: {}"
equal "a gap with cut faces: warnings" "$(cat "$work/errors")" ""
two 0.08 0 "$standard
failure: {critical stretch: 0.01}
contact: {friction: 2, stiffness: 2}"
equal "the most usual contact: warnings" "$(cat "$work/errors")" ""
contains "contact and breakage" "$(cat "$work/out")" "contact: 2 times as stiff as the body, friction 2 on faces of cuts and of different bodies; faces of broken bonds interlock"
two 0.08 0 "$standard
contact: {friction: 60, stiffness: 10}"
contains "friction in per cent" "$(cat "$work/errors")" "two.yaml:10:21: friction: 60 is more than faces of anything have; it is a number, not per cent"
contains "stiff contact" "$(cat "$work/errors")" "two.yaml:10:36: stiffness: faces 10 times as stiff as the body meet within a step or two"
two 0.08 0 "solve: {explicit: {steps: 3, safety: 0.5}}
contact: {stiffness: 10}"
equal "stiff contact, half the step: warnings" "$(cat "$work/errors")" ""
# each limit from its two sides: friction and stiffness of 2, 0.55 of the stable step, gaps of 0.75 and overlaps of 0.25 spacings
two 0.08 0 "$standard
contact: {friction: 2.01}"
contains "much friction" "$(cat "$work/errors")" "friction: 2.01 is more than"
for safety in 0.54 0.56; do
  two 0.08 0 "solve: {explicit: {steps: 3, safety: $safety}}
contact: {stiffness: 2.01}"
  equal "stiff contact at $safety of the step: warnings" "$(grep -c 'stiffness: faces 2.01 times as stiff' "$work/errors")" "$(echo $safety | grep -c 6)"
done
two 0.0148 0 "$standard"
equal "a narrow gap: warnings" "$(cat "$work/errors")" ""
two 0.0152 0 "$standard"
contains "a gap" "$(cat "$work/errors")" "blocks 'a' and 'b' are 15.2 mm apart"
two -0.0148 0 "$standard"
equal "a slight overlap: warnings" "$(cat "$work/errors")" ""
two -0.0152 0.1 "$standard"
contains "an overlap" "$(cat "$work/errors")" "overlap: 5 particles of the first stand inside the second, 5 of the second inside the first,"

# Plane decks with keys of space, and the reverse; brackets and dashes
refuse 's/to: \[1, 0.5, 0.3\]/to: [1, 0.5]/' 10:13 "box: it has no size along z; give points three numbers, or take 'lattice: square' for a plane body"
refuse 's/    spacing: 0.1$/    spacing: 0.1\n    lattice: square\n    thickness: 1/; s/face: x+/face: z+/; s/^peri.*/peridynamics: {space: plane strain}/' \
  14:15 'face: the body has no face z+; it is plane: x-, x+, y- or y+'
refuse 's/\[0.45, 0.2\]\]}}/[0.45, 0.2]}}/' 14:41 'a bracket is opened and not closed'
refuse 's/^  plate:/  - plate:/' 6:1 "body: expected names, each with its keys and values; found a list: leave out the '- '"
refuse 's/force: kN/force: kn/' 2:1 "units: unit 'kn' is not known; expected a unit of force, like N, kN or lbf"

# Reinforcing bars
steel='s/^  steel: .*/  steel: {model: menegotto-pinto, density: 7.85, Young modulus: 200 GPa, yield stress: 500 MPa}/'
along='points: [[0.05, 0.25, 0.15], [0.95, 0.25, 0.15]]'
across='points: [[0.05, 0.05, 0.15], [0.05, 0.45, 0.15]]'
fib='bond: {compressive strength: 38 MPa, rib spacing: 8 mm}'
sed "$steel; s/^failure: .*/&\nbars: {r: {$along, diameter: 16 mm, material: steel, bending: yes, $fib, anchored: [start, end]}}/" "$work/good.yaml" > "$work/barred.yaml"
"$breccia" check "$work/barred.yaml" > "$work/out" 2>&1 || fail "a good bar is refused: $(cat "$work/out")"
# bar KEYS PLACE WORDS [EDIT]: the good deck with a bar of these keys
bar() { refuse "$steel; s/^failure: .*/&\nbars: {r: {$1, material: steel}}/${4:+; $4}" "$2" "$3"; }
bar "$along, diameter: 0" 17:72 'diameter: 0 is out of range; it must be greater than 0'
bar "$along, diameter: 16 mm2" 17:72 "diameter: '16 mm2' has the wrong dimension; a length is left over; expected a length"
bar "$along, area: 2 cm" 17:68 "area: '2 cm' has the wrong dimension; a length is missing; expected an area"
bar "$along" 17:8 "bar: none of 'diameter', 'area' is given; give exactly one"
bar "$along, diameter: 16 mm, number: 0" 17:87 'number: 0 is out of range'
bar "$along, diameter: 16 mm, number: 100000000000000000000" 17:87 'is not a whole number'
bar 'points: [[-1, 0.25, 0.15], [3, 0.25, 0.15]], diameter: 16 mm' 17:12 "points: bar 'r' is outside the body at [-1, 0.25, 0.15], 10.5 spacings from the nearest particle; keep its line within the body"
bar 'points: [[0.05, 0.25, 0.15]], diameter: 16 mm' 17:12 'points: a bar needs two or more'
bar 'points: [0.05, 0.25, 0.15], diameter: 16 mm' 17:12 'points: expected a list of points, like [[0, 0], [1, 0]]'
bar 'points: [[0.05, 0.25, 0.15], [0.05, 0.25, 0.15]], diameter: 16 mm' 17:12 'points: points 1 and 2 are the same; leave one out'
bar 'points: [[0.05, 0.25, 0.15], [0.5, 0.25, 0.15], [0.50000009, 0.25, 0.15]], diameter: 16 mm' 17:12 "points: points 2 and 3 of bar 'r' are 9e-08 apart, which is nothing beside the spacing of 0.1; leave one out"
bar "$along, diameter: 16 mm, bending: yes, snap: yes" 17:88 "bending: a line that is moved to particles has a corner at each of them"
bar 'points: [[0.05, 0.25, 0.15], [0.1, 0.25, 0.15]], diameter: 16 mm, bending: yes' 17:87 'bending: no two elements of this line lie on one straight line'
bar "$along, diameter: 16 mm, anchored: [start]" 17:79 "anchored: a bar in perfect bond slips nowhere; add 'bond', or leave this out"
bar "$along, diameter: 16 mm, $fib, anchored: [middle]" 17:136 "anchored: 'middle' is no end of a bar; take 'start' (its first point) or 'end' (its last)"
bar "$along, diameter: 16 mm, $fib, anchored: [end, end]" 17:136 "anchored: 'end' stands here twice; take [start, end], or leave one out"
bar "$along, diameter: 16 mm, $fib, bonded: [0, 900]" 17:136 "bonded: bar 'r' is 0.9 m long, from 0 to there; give lengths along it"
bar "$along, diameter: 16 mm, $fib, bonded: [0.5, 0.1]" 17:136 'bonded: two lengths along the bar, from its first point; the second is not the smaller one'
bar "$along, diameter: 16 mm, bond: yes" 17:85 'bond: expected keys and values'
bar "$along, diameter: 16 mm, bond: {law: linear}" 17:79 "stiffness: law 'linear' needs it, the stress on the surface of the bar per slip, like 100 MPa/mm"
bar "$across, diameter: 16 mm, repeat: {along: [1, 0, 0], pitch: 0, number: 3}" 17:113 'pitch: 0 is out of range'
bar "$across, diameter: 16 mm, repeat: {along: [1, 0, 0], pitch: 0.1, number: 1}" 17:126 'number: 1 is out of range; it must be at least 2'
bar "$across, diameter: 16 mm, repeat: {along: [1, 0, 0], pitch: 100, number: 2}" 17:79 "repeat: bar 'r 2' is outside the body at [100.05, 0.05, 0.15], 991 spacings"
bar "$across, diameter: 16 mm, repeat: {along: [1, 0, 0], pitch: 0.1, number: 3}, material: steel}, r 2: {$across, diameter: 16 mm" 17:148 "bars: 'r 2' is also the name of a line of a bar with 'repeat'; call it otherwise"
bar "$along, diameter: 16 mm" 5:3 "material 'steel' (menegotto-pinto): 'initial stress' is beyond the yield stress, and the first strain would lead back" \
  's/yield stress: 500 MPa/yield stress: 500 MPa, initial stress: 501 MPa/'
bar "$along, diameter: 16 mm" 5:3 "material 'steel' (elastic-perfectly-plastic): 'initial strain' makes a stress of -5.02e+05 at first, beyond the yield stress; take one from -0.0025 to 0.0025" \
  's/menegotto-pinto\(.*500 MPa\)/elastic-perfectly-plastic\1, initial strain: 0.00251/'
bar "$along, diameter: 16 mm" 5:3 "'initial strain' makes a stress of 2.02e+05 at first, beyond the yield stress; take one from -0.001 to 0.0025" \
  's/menegotto-pinto\(.*\)500 MPa/elastic-perfectly-plastic\1200 MPa, compressive yield stress: 500 MPa, initial strain: -0.00101/'
for equations in 'static: {increments: 1' 'implicit: {end time: 1, time step: 0.1'; do
  held='s/body force: \[1, 0, 0\]/displacement: [0, 0, 0]/'
  bar "$along, diameter: 16 mm, bending: yes" '' "equations: 'direct' needs the stiffness as a matrix, and the bending of a bar joins particles of two elements; take 'conjugate gradients'" \
    "$held; s/^solve: .*/solve: {$equations, equations: direct}}/"
  bar "$along, diameter: 16 mm, $fib" '' "equations: 'direct' needs the stiffness as a matrix, and the slips of a bar join all particles along it; take 'conjugate gradients'" \
    "$held; s/^solve: .*/solve: [{explicit: {steps: 1}}, {$equations, equations: direct}}]/"
done
pulled() { bar "$along, diameter: 16 mm" 20:18 "$2" "s/^  - {name: pull.*/&\n  - {prestress: {$1, stress: 100 MPa}}/"; }
pulled 'bars: [x]' "bars: there is no bar 'x'; expected names of those under 'bars' of the deck"
pulled 'bars: []' "bars: name those that are under tension, as under 'bars' of the deck"
pulled 'bars: [r, r]' "bars: 'r' stands here twice; leave one out"

# what bars are named for says nothing more where these are wrong themselves
refuse "$steel; s/^failure: .*/&\nbars: {r: {$along, diameter: 16 mm, material: steal}}/; s/^  - {name: pull.*/&\n  - {prestress: {bars: [r], stress: 100 MPa}}/; s/^  - {field: damage}/&\n  - {bars: stress}/; s/^watch:/&\n  bar: {bar: r}/" \
  17:89 "there is no material 'steal'; did you mean 'steel'?"

# Files that are no decks at all
for content in '' '- a' 'words' '42' '%' '%TAG'; do
  printf '%s' "$content" > "$work/deck.yaml"
  (cd "$work" && timeout 600 "$breccia" check deck.yaml > out 2> errors)
  equal "deck «$content»: exit status" $? 2
  contains "deck «$content»" "$(cat "$work/errors")" "deck.yaml:1:"
done
# What stands behind the first document of YAML, which is all that is read
for ending in '---\ntitle: Another' '...\nwatch: {}' '--- # and more'; do
  { cat "$work/good.yaml"; printf -- "$ending\n"; } > "$work/deck.yaml"
  (cd "$work" && "$breccia" check deck.yaml > out 2> errors)
  equal "$ending: exit status" $? 2
  contains "$ending" "$(cat "$work/errors")" "a file holds one deck, and what stands here would not be read"
done
{ printf '# mine\n---\n'; cat "$work/good.yaml"; printf '...\n\n# the end\n'; } > "$work/deck.yaml"
(cd "$work" && "$breccia" check deck.yaml > out 2> errors) || fail "a deck between marks: $(cat "$work/errors")"
refuse 's/length: m/length: -1 m/' 2:1 "unit '-1 m' is none to count length in"
# Files without an end, folders, and more than anybody writes: refused soon, with their place
mkfifo "$work/pipe"
for file in /dev/zero pipe .; do
  case $file in .) what='a directory' ;; *) what='a pipe or a device' ;; esac
  (cd "$work" && timeout 60 "$breccia" check $file > out 2> errors)
  equal "$file as deck: status" $? 2
  contains "$file as deck" "$(cat "$work/errors")" "$file: cannot be read: "
  refuse "s#^title: .*#include: $file#" 1:10 'is not a file of at most 64 MB'
  refuse "s#ramp to: 1 ms#file: {name: $file}#" 18:73 "$file: "
  refuse "s#shape: .*#file: $file#" 10:11 "$file: "
done
many() { seq "$1" | sed "s/.*/$2/"; }
{ cat "$work/good.yaml"; echo 'variables:'; many 100001 '  v&: 1'; } > "$work/deck.yaml"
(cd "$work" && timeout 120 "$breccia" check deck.yaml > out 2> errors)
equal "100001 keys" "$? $(cat "$work/errors")" "2 deck.yaml:25:1: 100001 keys in one map are too many; it may hold 100000"
{ grep -v '^loads\|name: pull\|^watch\|^  tip' "$work/good.yaml"; echo 'loads:'; many 100001 '  - {on: end, force: [1, 0, 0]}'; } > "$work/deck.yaml"
(cd "$work" && timeout 120 "$breccia" check deck.yaml > out 2> errors)
equal "100001 loads" "$? $(cat "$work/errors")" "2 deck.yaml:21:1: loads: 100001 are too many; there may be 100000"
long=$(printf '%4000s' '' | tr ' ' a)
refuse "s/spacing: 0.1\$/spacing: $long/" 9:14 'aaaa...'"'"' is not a number'
equal "a long value: letters" "$(($(wc -c < "$work/errors") < 300))" 1
refuse "s/titl/$long/" 1:1 'aaaa...'"'"'; '
refuse 's/horizon: 3.015 spacings/horizon: 31 spacings/' 15:25 'would have more than 65535 bonds'
refuse 's/density: 1.5/density: 1e-320/' 4:42 "density: 1e-320 is too small to reckon with; in the deck's units numbers lie between 1e-50 and 1e+50"
refuse 's/210 GPa/1e52/' 5:57 'is too large to reckon with'
refuse 's/spacing: 0.1$/spacing: 1e-60/' 9:14 'is too small'

cat > "$work/test.yaml" <<'Y'
material: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}
test: {kind: uniaxial, strain: 0.01}
Y
"$breccia" run "$work/test.yaml" > /dev/null 2> "$work/errors"
equal "run of a test: status" $? 2
contains "run of a test" "$(cat "$work/errors")" "test.yaml: is a laboratory test; 'breccia material "
"$breccia" material "$work/good.yaml" > /dev/null 2> "$work/errors"
equal "test of a deck: status" $? 2
contains "test of a deck" "$(cat "$work/errors")" "good.yaml: is a deck; 'breccia run "
"$breccia" check "$work/none.yaml" > /dev/null 2> "$work/errors"
equal "missing deck: exit status" $? 2
contains "missing deck" "$(cat "$work/errors")" "none.yaml: cannot be read: No such file"
finish

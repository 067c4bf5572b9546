# Several runs of one deck: cases, their folders, the table, and going on after a stop.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
# A bar that is pulled slowly against damping: at the end its stress is E times its strain.
cat > bar.yaml <<'Y'
title: Bar
variables: {E: 30 GPa, speed: 1 mm/s}
materials: {rock: {model: elastic, density: 2400 kg/m3, Young modulus: "${E}", Poisson ratio: 0}}
body: {bar: {material: rock, spacing: 20 mm, shape: {box: {from: [0, 0, 0], to: [0.2, 0.06, 0.06]}}}}
selections: {end: {face: x+}}
loads:
  - {name: pull, on: end, velocity: ["${speed}", 0, 0]}
  - {on: {face: x-}, displacement: [0, free, free]}
solve: {explicit: {end time: 2 ms}}
watch: {end: {displacement of: end}, jack: {force on: end}}
pictures: [{curve: 'end.x : jack.x'}]
Y
"$breccia" study bar.yaml --vary 'variables.E=10 GPa:30 GPa:3' --vary 'variables.speed=1 mm/s, 2 mm/s' --result 'last end.x' --result 'peak jack.x' --result peaks.displacement --jobs 2 > out 2> errors || fail "study: $(cat out errors)"
equal "cases" "$(cut -d, -f1-4 bar-study/table.csv)" 'case,variables.E,variables.speed,state
E-10-GPa--speed-1-mm-s,10 GPa,1 mm/s,done
E-10-GPa--speed-2-mm-s,10 GPa,2 mm/s,done
E-20-GPa--speed-1-mm-s,20 GPa,1 mm/s,done
E-20-GPa--speed-2-mm-s,20 GPa,2 mm/s,done
E-30-GPa--speed-1-mm-s,30 GPa,1 mm/s,done
E-30-GPa--speed-2-mm-s,30 GPa,2 mm/s,done'
equal "heading" "$(head -1 bar-study/table.csv | cut -d, -f5-)" 'last end.x (m),peak jack.x (N),peaks.displacement (m)'
# Twice the speed, twice the displacement; and the force, which is linear in both.
awk -F, 'NR > 1 {u[NR] = $5; f[NR] = $6 < 0 ? -$6 : $6} END {
  for (k = 2; k <= 6; k += 2) if (u[k] / 2e-6 - 1 > 1e-6 || u[k] / 2e-6 - 1 < -1e-6 || f[k + 1] / f[k] - 2 > 1e-3 || f[k + 1] / f[k] - 2 < -1e-3) exit 1
  if (f[6] < 2 * f[2]) exit 1 }' bar-study/table.csv || fail "figures of the cases: $(cat bar-study/table.csv)"
contains "readable table" "$(cat bar-study/table.txt)" '     10 GPa           1 mm/s   done'
equal "printed table" "$(sed -n '/^variables/,/^$/p' out | sed '$d')" "$(cat bar-study/table.txt)"
for file in jack-over-end.png last-end.x.png peak-jack.x.png E-10-GPa--speed-1-mm-s/summary.json E-10-GPa--speed-1-mm-s/log.txt; do
  [ -s "bar-study/$file" ] || fail "bar-study/$file is missing"
done
# A case is the run with its settings.
"$breccia" run bar.yaml --quiet --set 'variables.E=20 GPa' --set 'variables.speed=2 mm/s' --output alone
cmp alone/jack.csv bar-study/E-20-GPa--speed-2-mm-s/jack.csv || fail "a case differs from the run with its settings"

# What is taken of a history: farthest from zero with its sign, largest, smallest, at the end; and values around zero are told as zero.
"$breccia" study bar.yaml --vary 'variables.speed=-0.1:0.2:4' --result 'peak jack.x' --result 'maximum jack.x' --result 'minimum jack.x' --result 'last jack.x' --output taken > out 2>&1 ||
  fail "study of speeds: $(cat out)"
equal "speeds" "$(cut -d, -f1,2 taken/table.csv | tr '\n' ' ')" "case,variables.speed speed--0.1,-0.1 speed-0,0 speed-0.1,0.1 speed-0.2,0.2 "
for speed in -0.1 0.1; do
  equal "taken at $speed" "$(awk -F, -v s=$speed '$2 == s {printf "%.6g %.6g %.6g %.6g", $4, $5, $6, $7}' taken/table.csv)" "$(awk -F, 'NR > 1 {
    if (NR == 2) {high = low = far = $3} if ($3 > high) high = $3; if ($3 < low) low = $3; if ($3 ^ 2 > far ^ 2) far = $3; last = $3}
    END {printf "%.6g %.6g %.6g %.6g", far, high, low, last}' "taken/speed-$speed/jack.csv")"
done
# Values that are spelt alike as files have folders of their own.
equal "names alike" "$("$breccia" study bar.yaml --vary 'title=a b, a-b, a/b' --check --output alike)" "1 of 3: title-a-b: to be run
2 of 3: title-a-b--2: to be run
3 of 3: title-a-b--3: to be run"

# What is done is not run again; what the deck has changed is; --again runs all.
arguments=(--vary 'variables.E=10 GPa, 20 GPa' --output few)
"$breccia" study bar.yaml "${arguments[@]}" > out || fail "second study: $(cat out)"
equal "second time" "$("$breccia" study bar.yaml "${arguments[@]}" --result peaks.velocity --result peaks.octahedral_shear_stress --result peaks.mean_stress_lowest \
  --result energy.external --result energy.imbalance --result time --result peaks.damage | grep ' of 2: ')" "1 of 2: E-10-GPa: was done
2 of 2: E-20-GPa: was done"
equal "units" "$(head -1 few/table.csv | cut -d, -f4-)" 'peaks.velocity (m/s),peaks.octahedral_shear_stress (Pa),peaks.mean_stress_lowest (Pa),energy.external (N*m),energy.imbalance,time (s),peaks.damage'
sed -i 's/density: 2400/density: 2500/' bar.yaml
equal "with another deck" "$("$breccia" study bar.yaml "${arguments[@]}" --check)" "1 of 2: E-10-GPa: to be run
2 of 2: E-20-GPa: to be run"
"$breccia" study bar.yaml "${arguments[@]}" --set 'materials.rock.density=2400 kg/m3' --check | grep -q 'to be run' && fail "a setting that gives the deck of before runs it again"
equal "again" "$("$breccia" study bar.yaml "${arguments[@]}" --again | grep -c ': done')" 2

# A stopped case goes on from its checkpoint, to the same end.
sed 's/end time: 2 ms/end time: 20 ms/' bar.yaml > long.yaml
"$breccia" study long.yaml --vary 'variables.E=20 GPa, 30 GPa' > out 2>&1 &
study=$!
started() { [ -s long-study/E-20-GPa/end.csv ] && [ "$(wc -l < long-study/E-20-GPa/end.csv)" -gt 3 ]; }
wait_for $study started
kill -TERM $study
wait $study
status=$?
if [ $status = 130 ]; then
  contains "stopped study" "$(cat out)" "goes on from here"
  contains "stopped case" "$("$breccia" study long.yaml --vary 'variables.E=20 GPa, 30 GPa' --check)" "1 of 2: E-20-GPa: to go on"
  cp -r long-study begun-study
  "$breccia" study long.yaml --vary 'variables.E=20 GPa, 30 GPa' --again --output begun-study | grep 'from its checkpoint' && fail "--again goes on with a case that was stopped"
  contains "going on" "$("$breccia" study long.yaml --vary 'variables.E=20 GPa, 30 GPa')" "1 of 2: E-20-GPa, from its checkpoint"
  equal "log of both runs of the case" "$(grep -cE '^(stopped|finished) ' long-study/E-20-GPa/log.txt)" 2
else
  equal "study that ended before it was stopped" $status 0
fi
"$breccia" run long.yaml --quiet --set 'variables.E=20 GPa' --output whole
cmp whole/jack.csv long-study/E-20-GPa/jack.csv || fail "a case that was stopped ends otherwise than a whole run"

# A case that fails is told, and takes no other with it.
"$breccia" study bar.yaml --vary 'solve.explicit.time step=1 us, 1 s' --output unstable > out 2> errors
equal "a case that fails: status" $? 1
contains "a case that fails" "$(cat errors)" "times the stable step"
equal "states" "$(cut -d, -f3 unstable/table.csv)" "state
done
not run"

# Side by side.
equal "together" "$("$breccia" study bar.yaml --vary 'variables.E=1 GPa:2 GPa:2' --vary 'variables.speed=1 mm/s, 2 mm/s' --together --check)" "1 of 2: E-1-GPa--speed-1-mm-s: to be run
2 of 2: E-2-GPa--speed-2-mm-s: to be run"

# refuse WORDS ARGUMENTS: refused in one line with these words, and nothing is written
refuse() {
  local words=$1
  shift
  "$breccia" study bar.yaml --output refused "$@" > out 2> errors
  equal "$*: status" $? 2
  equal "$*" "$(cat errors)" "$words"
  [ -e refused ] && fail "$*: something was written"
}
refuse "give what is varied, like --vary 'body.beam.spacing=2 mm:8 mm:4'"
refuse "--vary E: expected key.path=from:to:n or key.path=a, b, c, like 'body.beam.spacing=2 mm:8 mm:4'" --vary E
refuse "--vary a: '1:2' should be from:to:n, like 5 mm:20 mm:4" --vary a=1:2
refuse "--vary a: '1' should be how many values there are, 2 to 1000" --vary a=1:2:1
refuse "--vary a: 'mm' and 'm' differ; give both ends in one unit, like 5 mm:20 mm:4" --vary 'a=1 mm:2 m:3'
refuse "--vary a: a value is empty" --vary a=1,,2
refuse "a study has at most 1000 cases" --vary a=1:2:100 --vary b=1:2:11
refuse "--together: a has 2 values and b has 3: they must be as many" --vary a=1,2 --vary b=1,2,3 --together
refuse "--set variables.F=1: there is no 'F'; the keys here are E, speed" --vary variables.F=1
refuse "--set body.bar.spacing=-1: spacing: -1 is out of range; it must be greater than 0" --vary body.bar.spacing=-1
finish

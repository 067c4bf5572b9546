# Pictures: every kind can be drawn, has the size and the colours that it should, and wrong wishes are told.
. "$(dirname "$0")/common.sh"
cd "$work"
cat > bar.yaml <<'Y'
title: "Bar: 50 % \"quoted\" & <odd>"
materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 1, shape: {box: {particles: [12, 6, 6]}}}}
loads: [{name: pull, on: {face: x+}, body force: [1, 0, 0]}]
solve: {explicit: {steps: 40}}
watch: {end: {displacement of: {face: x+}}, pull: {load: pull}, ledger: {energy: yes}}
results: {number: 2, fields: [displacement, stress, damage]}
pictures:
  - {field: damage}
  - {field: damage, deformed: 5}
  - {field: stress, component: xx, at: [0, 1e9], title: "Stress", x label: "along"}
  - {field: displacement, name: moved}
  - {curve: "end.x : pull.value", y label: "Pull of the grip"}
  - {energy: yes, title: "Where the work went"}
Y
"$breccia" run bar.yaml > out 2>&1 || fail "run: $(cat out)"
# names are short, and no picture takes the place of another
equal "names" "$(ls bar/pictures | tr '\n' ' ')" "damage-2.png damage.png ledger.png moved.png pull-over-end.png stress-xx-0s.png "
sed '/^  - /d; s/^pictures:/pictures: []/; s/^title.*/title: Bare/' bar.yaml > bare.yaml
"$breccia" run bare.yaml > out 2>&1 || fail "run without pictures: $(cat out)"
equal "no pictures asked for" "$(ls bare/pictures 2> errors | wc -l)" 0
sed '/^pictures/d' bare.yaml > usual.yaml
"$breccia" run usual.yaml > out 2>&1 || fail "run with the usual pictures: $(cat out)"
equal "the usual pictures" "$(ls usual/pictures | tr '\n' ' ')" "damage.png displacement.png "
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
# a bar of 12 x 6 x 6 lies wide from its side, stands high from above with x upwards, and shows its square end from the front
sizes() { "$breccia" plot bar --field damage --view="$1" --output view.png > out 2>&1 && od -An -tu1 -j16 -N8 view.png | awk '{print 256 * $3 + $4, 256 * $7 + $8}'; }
read -r side_wide side_high <<< "$(sizes 90:0)"
read -r top_wide top_high <<< "$(sizes 0:90)"
read -r end_wide end_high <<< "$(sizes 0:0)"
[ $((end_high - side_high)) -gt 100 ] && [ $((top_high)) = $((end_high)) ] || fail "heights from the side, above, the front: $side_high $top_high $end_high"
[ $((end_wide - top_wide)) -gt 100 ] && [ $((side_wide)) -gt $((end_wide)) ] || fail "widths from the side, above, the front: $side_wide $top_wide $end_wide"
checks=$((checks + 2))
# a part of a body: the deck's shape and the box of a plot are the same picture; a box around all of it leaves nothing out
sed 's/^  - {field: damage}$/  - {field: displacement, inside: {box: {from: [-1, 3, -1], to: [13, 7, 7]}}, name: half}/' bar.yaml > half.yaml
"$breccia" run half.yaml > out 2>&1 || fail "half: $(cat out)"
"$breccia" plot half --field displacement --inside :,3:,: --output half.png > out 2>&1 || fail "half: $(cat out)"
"$breccia" plot half --field displacement --inside=-1:13,-1:7,-1:7 --output all.png > out 2>&1 || fail "all: $(cat out)"
"$breccia" plot half --field displacement --output whole.png > out 2>&1 || fail "whole: $(cat out)"
cmp half.png half/pictures/half.png || fail "half a body differs from the deck's picture of it"
cmp all.png whole.png || fail "a box around all of a body leaves something out"
cmp -s half.png whole.png && fail "half a body is drawn as all of it"
"$breccia" plot half --field displacement --inside :,3: --output two.png > out 2>&1 || fail "two ranges: $(cat out)"
cmp half.png two.png || fail "a range along z that is left out is no limit"
checks=$((checks + 4))
refused_plot() { # options, words
  "$breccia" plot half --field displacement --inside "$1" --output no.png > out 2> errors
  equal "--inside $1: status" $? 2
  contains "--inside $1" "$(cat errors)" "$2"
  equal "--inside $1: lines" "$(wc -l < errors)" 1
}
for wrong in "1:2" ":," ":,:," ":,:,:,:" "a:2,:,:" "0-1,:,:" ":,:,inf:"; do refused_plot "$wrong" "--inside: '$wrong' should be two or three ranges with commas between them, like :,0:2,:"; done
refused_plot ":,2:1,:" "inside: along y the lower end 2 is not below the upper one, 1"
refused_plot ":,20:,:" "inside: none of the 432 particles stands in this shape"
printf 'a,b\n0,0\n1,1\n' > measured.csv
"$breccia" plot bar --curve "end.time : end.x" --output plus.svg > out 2>&1 || fail "plus: $(cat out)"
"$breccia" plot bar --curve "end.time : - end.x" --output minus.svg > out 2>&1 || fail "minus: $(cat out)"
contains "minus: label" "$(cat minus.svg)" "-end, x"
# the largest number at the axis has become the smallest
numbers() { sed -n 's/.*<tspan[^>]*>[ ]*\([-−]\{0,1\}[0-9.]*\)[ ]*<.*/\1/p' "$1" | sed 's/−/-/' | sort -g; }
lowest=$(numbers minus.svg | head -1)
contains "minus: numbers" "$lowest" "-"
contains "minus: numbers" " $(numbers plus.svg | tr '\n' ' ')" " ${lowest#-} "
"$breccia" plot bar bar --curve "end.x:end.y" --overlay measured.csv --output curve.png > out 2>&1 || fail "overlay: $(cat out)"
"$breccia" plot bar --curve "end.x:end.y" --overlay measured.csv --output curve.svg > out 2>&1 || fail "overlay: $(cat out)"
for word in "bar" "measured"; do contains "legend of points laid over a curve" "$(cat curve.svg)" ">$word<"; done
# units that read well, labels and titles that are asked for, legends by folder
sed 's/units:.*//; 1i units: {length: m, force: kN, time: s}' bar.yaml > other.yaml
"$breccia" run other.yaml > out 2>&1 || fail "other: $(cat out)"
"$breccia" plot other --energy --output energy.svg > out 2>&1 || fail "energy: $(cat out)"
contains "energies: time" "$(cat energy.svg)" "Time ["
for word in kinetic internal external "[kJ]"; do contains "energies" "$(cat energy.svg)" "$word"; done
case $(cat energy.svg) in *imbalance* | *"broken bonds"* | *damping*) fail "energies: what is none, or zero, is drawn" ;; esac
cp -r other again
"$breccia" plot other again/ --curve "end.time : end.x, end.y" --title "Ends, moved" --y-label "How far" --output curve.svg > out 2>&1 ||
  fail "several: $(cat out)"
for word in "Ends, moved" "How far" "other: x" "again: y" "Time ["; do contains "several runs" "$(cat curve.svg)" "$word"; done
"$breccia" plot other --curve "end.time : end.x" --log y --output log.svg > out 2>&1 || fail "log: $(cat out)"
"$breccia" plot other --field displacement --time 0 --range each > out 2>&1 || fail "each: $(cat out)"
equal "name of a plot" "$(cat out)" "other/pictures/displacement-0s.png"
# --time takes the nearest of the states at 0, a half and the whole of the run
end=$(tail -1 other/end.csv | cut -d, -f2)
for near in 0.1:0 0.45:20 0.55:20 0.8:40 1:40; do
  "$breccia" plot other --field displacement --time "$(awk -v e="$end" -v s="${near%:*}" 'BEGIN {printf "%.12g", s * e}')" --output time.png > out 2>&1 ||
    fail "--time: $(cat out)"
  "$breccia" plot other --field displacement --step "${near#*:}" --output step.png > out 2>&1 || fail "--step: $(cat out)"
  cmp -s time.png step.png || fail "--time ${near%:*} of the run is not step ${near#*:}"
  checks=$((checks + 1))
done
"$breccia" plot other --energy > out 2> errors || fail "energy: $(cat errors)"
equal "name of the energies" "$(cat out)" "other/pictures/ledger.png"
# rows of histories that are written seldom belong to those of the same steps: over the same thing both axes have the same numbers
cat > flat.yaml <<'Y'
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.05, shape: {box: {from: [0, 0], to: [2.2, 0.65]}}}}
peridynamics: {space: plane strain}
loads: [{on: {face: x+}, body force: [1, 0]}]
solve: {explicit: {steps: 40}}
watch: {often: {displacement of: {face: x+}}, seldom: {displacement of: {face: x+}, every: 7}}
results: {number: 2, fields: [displacement]}
pictures: []
Y
"$breccia" run flat.yaml > out 2>&1 || fail "flat: $(cat out)"
"$breccia" plot flat --curve "often.time : seldom.time" --output same.svg > out 2>&1 || fail "same: $(cat out)"
equal "a time over itself" "$(numbers same.svg | uniq -c | awk '$1 != 2' | wc -l)" 0
# numbers at the upright axis stand where their places are: 0 at the lower end of the body, 0.6 a thirteenth below its upper end
"$breccia" plot flat --field displacement --deformed 0 --output flat.svg > out 2>&1 || fail "flat: $(cat out)"
grep -o 'd="M [0-9.]* [0-9.]* L [0-9.]* [0-9.]* *"' flat.svg | tr -d '"' | awk '$3 == $6 && $5 - $2 == 4 {print $3}' | sort -n > marks
grep -o 'd="M [0-9.]* [0-9.]* L [0-9.]* [0-9.]* L [0-9.]* [0-9.]* ' flat.svg | awk '$5 - $2 > 300 && $3 == $6 {print $3 + 6, $9 - 6}' > ends
read -r upper lower < ends
awk -v upper="$upper" -v lower="$lower" 'function near(a, b) {return (a - b) ^ 2 < 1}
  NR == 1 {first = $1} {last = $1} END {exit !(NR > 2 && near(last, lower) && near(first, upper + (lower - upper) / 13))}' marks ||
  fail "marks at the upright axis: $(cat ends marks | tr '\n' ' ')"
# the colours of a picture of the run reach over all its states, as those of `breccia plot` do: what moves less and less
cat > fade.yaml <<'Y'
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [0, 0], to: [2, 0.6]}}}}
peridynamics: {space: plane strain}
loads: [{on: {all: yes}, initial velocity: {translation: [1, 0]}}]
solve: {explicit: {end time: 0.02, damping: 300}}
results: {number: 4, fields: [velocity]}
pictures: [{field: velocity, at: [0.01]}]
Y
"$breccia" run fade.yaml > out 2>&1 || fail "fade: $(cat out)"
"$breccia" plot fade --field velocity --time 0.01 --output late.png > out 2>&1 || fail "fade: $(cat out)"
cmp late.png fade/pictures/velocity-10ms.png || fail "a picture of the run has other colours than the same one drawn afterwards"
checks=$((checks + 1))
# movies: what ffmpeg is given, what it makes where it is installed, and what is said where it is not
mkdir programs
cat > programs/ffmpeg <<'Y'
#!/bin/sh
wc -c > bytes
for word; do echo "$word"; last=$word; done > words
echo made > "$last"
Y
chmod +x programs/ffmpeg
PATH="$work/programs:$PATH" "$breccia" plot bar --field displacement --movie bar.mp4 > out 2>&1 || fail "movie: $(cat out)"
equal "movie" "$(cat out) $(cat bar.mp4)" "bar.mp4 made"
size=$(grep -x '[0-9]*x[0-9]*' words)
equal "frames" "$(cat bytes)" $((3 * ${size%x*} * ${size#*x} * 4))
[ ${size%x*} -gt 300 ] && [ ${size#*x} -gt 200 ] || fail "a movie of $size pixels"
equal "even pixels" "$((${size%x*} % 2)) $((${size#*x} % 2))" "0 0"
for word in yuv420p libx264; do contains "movie" "$(cat words)" $word; done
rm bar.mp4
printf '#!/bin/sh\necho Unknown encoder >&2\nexit 1\n' > programs/ffmpeg
PATH="$work/programs:$PATH" "$breccia" plot bar --field damage --movie bar.mp4 > out 2> errors
equal "failing ffmpeg: status" $? 1
contains "failing ffmpeg" "$(cat errors)" "Unknown encoder"
PATH=/nowhere "$breccia" plot bar --field damage --movie bar.mp4 > out 2> errors
equal "no ffmpeg: status" $? 1
contains "no ffmpeg" "$(cat errors)" "ffmpeg, which is not installed"
equal "no ffmpeg: lines" "$(grep -c '' < errors)" 1
equal "nothing is left of movies" "$(ls | grep mp4)" ""
if command -v ffmpeg > /dev/null; then
  "$breccia" plot bar --field displacement --movie bar.mp4 > out 2>&1 || fail "ffmpeg: $(cat out)"
  equal "movie in H.264" "$(ffprobe -v error -show_entries stream=codec_name,pix_fmt -of csv=p=0 bar.mp4)" "h264,yuv420p"
fi
# histories of laws are fields too
sed 's/model: elastic.*Poisson ratio: 0.2/model: multi-yield-j2, density: 1, shear modulus: 60, bulk modulus: 100, octahedral strength: 1e-3/
     s/damage]/damage, active surface]/; s/, ledger: {energy: yes}//; /energy: yes/d' bar.yaml > clay.yaml
"$breccia" run clay.yaml > out 2>&1 || fail "clay: $(cat out)"
"$breccia" plot clay --field "active surface" --output surface.png > out 2>&1 || fail "active surface: $(cat out)"
# reinforcing bars: over the body, over their length, of the run and afterwards
cat > steel.yaml <<'Y'
title: Steel
units: {length: m, force: kN, time: s}
materials:
  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}
  steel: {model: steel-bilinear, density: 7.85, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01}
body: {b: {material: soft, lattice: square, spacing: 0.05, thickness: 0.1, shape: {box: {from: [0, 0], to: [2, 0.6]}}}}
bars:
  along: {points: [[0.2, 0.2], [1.8, 0.2]], diameter: 0.01, material: steel, bond: {law: linear, stiffness: 1.4e7}}
  across: {points: [[0.5, 0.1], [0.5, 0.5]], area: 2e-4, material: steel, repeat: {along: [1, 0], pitch: 0.2, number: 7}}
peridynamics: {formulation: bond-based, space: plane stress}
loads: [{on: {all: yes}, field: {displacement: ['0.001*x', '-0.0005*y']}, history: {ramp to: 1}}]
solve: {static: {increments: 4, end time: 1}}
results: {number: 2}
pictures:
  - {bars: stress, deformed: 50}
  - {bars: slip, at: [0.5], name: slips}
  - {bars: stress, over length: yes, at: [0.5, 1]}
Y
"$breccia" run steel.yaml > out 2>&1 || fail "steel: $(cat out)"
equal "pictures of bars" "$(ls steel/pictures | tr '\n' ' ')" "bar-stress.png bars-stress.png slips.png "
"$breccia" plot steel --bars stress --deformed 50 --output again.png > out 2>&1 || fail "bars: $(cat out)"
cmp again.png steel/pictures/bars-stress.png || fail "a picture of bars of the run differs from the same one drawn afterwards"
"$breccia" plot steel --bars slip --time 0.5 --output again.png > out 2>&1 || fail "slip: $(cat out)"
cmp again.png steel/pictures/slips.png || fail "a picture of slips of the run differs from the same one drawn afterwards"
"$breccia" plot steel --bars stress --over-length --time 0.5,1 --output again.png > out 2>&1 || fail "over length: $(cat out)"
cmp again.png steel/pictures/bar-stress.png || fail "curves over the length of bars of the run differ from the same ones drawn afterwards"
checks=$((checks + 3))
for file in bars.png bars.svg bars.pdf; do
  "$breccia" plot steel --bars "bond stress" --output $file > out 2>&1 || fail "$file: $(cat out)"
  [ "$(wc -c < $file)" -gt 2000 ] || fail "$file is too small to be a picture"
  checks=$((checks + 1))
done
"$breccia" plot steel --bars strain --step all > out 2>&1 || fail "strain: $(cat out)"
equal "names of plots of bars" "$(tr '\n' ' ' < out)" "steel/pictures/bars-strain-0s.png steel/pictures/bars-strain-0.5s.png steel/pictures/bars-strain-1s.png "
"$breccia" plot steel --bars stress --over-length --output long.svg > out 2>&1 || fail "over length: $(cat out)"
for word in "Stress along bars at 1 s: 6 of 8, those with the largest" ">along<" "[MPa]" "Along the bar [m]"; do contains "over length" "$(cat long.svg)" "$word"; done
# of some bars, by their names or those of their lines; a name of the program's own does not take the place of another picture unsaid
"$breccia" plot steel --bars stress --over-length --of-bars across --output long.svg > out 2>&1 || fail "over length of bars: $(cat out)"
contains "over length of bars" "$(cat long.svg)" "Stress along bars at 1 s: 6 of 7, those with the largest"
[ -z "$(grep '>along<' long.svg)" ] || fail "over length: a bar that was not asked for"
"$breccia" plot steel --bars slip --over-length --of-bars "across 3, along" --output long.svg > out 2>&1 || fail "over length of bars: $(cat out)"
for word in ">across 3<" ">along<" "Slip along bars at 1 s"; do contains "over length of two bars" "$(cat long.svg)" "$word"; done
[ -z "$(grep 'across 2<\|those with' long.svg)" ] || fail "over length: a line that was not asked for"
equal "nothing is said of a name that is given" "$(cat out)" long.svg
"$breccia" plot steel --bars stress --over-length > out 2> errors || fail "over length: $(cat errors)"
equal "a picture that takes the place of another: status and name" "$(cat out)" steel/pictures/bar-stress.png
equal "a picture that takes the place of another" "$(cat errors)" "breccia plot: steel/pictures/bar-stress.png has taken the place of the picture that was there; --output names another file"
checks=$((checks + 2))
"$breccia" plot steel --bars slip --over-length --time 0,0.5,1 --output slip.svg > out 2>&1 || fail "slips: $(cat out)"
for word in "Slip along bar 'along'" ">0.5 s<" ">1 s<" "Slip [µm]"; do contains "slips over length" "$(cat slip.svg)" "$word"; done
sed 's/^pictures:/pictures: []/; /^  - {bars/d' steel.yaml > none.yaml
sed '/^pictures/d' none.yaml > usual.yaml
"$breccia" run usual.yaml --output steels > out 2>&1 || fail "usual pictures of bars: $(cat out)"
equal "the usual pictures of bars" "$(ls steels/pictures | tr '\n' ' ')" "bar-stress.png damage.png displacement.png octahedral-shear-stress.png "
refused_bars() { # refused_bars WORDS PICTURE [EDIT]: a deck with this picture
  sed "s/^pictures: \[\]/pictures: [$2]/; ${3:-}" none.yaml > refused.yaml
  "$breccia" check refused.yaml > out 2> errors
  equal "$2: status" $? 2
  contains "$2" "$(cat errors)" "$1"
  equal "$2: lines: $(cat errors)" "$(wc -l < errors)" 1
}
refused_bars "bars: 'stresses' is not known; did you mean 'stress'? (choose from strain, stress, force, dissipated, slip, bond stress)" "{bars: stresses}"
refused_bars "bars: 'slip' is of bars with a 'bond', and none has one" "{bars: slip}" "s/, bond: {[^}]*}//"
refused_bars "bars: there are none to draw: the deck has no section 'bars'" "{bars: stress}" "/^bars:/d; /^  along:/d; /^  across:/d; /^  steel:/d"
refused_bars "of bars: there is no bar 'cross'; did you mean 'across'?" "{bars: stress, over length: yes, of bars: [along, cross]}"
refused_bars "of bars: there is no bar 'across 8'" "{bars: stress, over length: yes, of bars: [across 8]}"
refused_bars "of bars: name those that are drawn, as under 'bars' of the deck" "{bars: stress, over length: yes, of bars: []}"
refused_bars "of bars: a picture of bars has no use for it; leave it out" "{bars: stress, of bars: [along]}"
# keys that a picture has no use for
refused_bars "over length: a picture of a field has no use for it; leave it out" "{field: damage, over length: yes}"
refused_bars "log axes: a picture of a field has no use for it; leave it out" "{field: damage, log axes: x}"
refused_bars "component: a picture of bars has no use for it; leave it out" "{bars: stress, component: xx}"
refused_bars "log axes: a picture of bars has no use for it; leave it out" "{bars: stress, log axes: y}"
for key in "deformed: 5" "view: [0, 20]" "inside: {box: {from: [0, 0], to: [1, 1]}}" "broken bonds: yes" "same range: no" "component: xx"; do
  refused_bars "${key%%:*}: a curve over the length of bars has no use for it; leave it out" "{bars: stress, over length: yes, $key}"
  refused_bars "${key%%:*}: a curve of histories has no use for it; leave it out" "{curve: 'end.time : end.x', $key}" "s/^results/watch: {end: {displacement of: {face: x+}}}\nresults/"
done
refused_bars "at: a curve of histories has no use for it; leave it out" "{energy: yes, at: [1]}" "s/^results/watch: {ledger: {energy: yes}}\nresults/"
refused_bars "at: curves over the length of bars are drawn at up to 6 times, and these are 7" "{bars: stress, over length: yes, at: [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}"
wrong() { # wrong WORDS ARGUMENTS ...
  words=$1
  shift
  "$breccia" plot "$@" > out 2> errors
  equal "plot $*: status" $? 2
  contains "plot $*" "$(cat errors)" "$words"
  equal "plot $*: lines: $(cat errors)" "$(wc -l < errors)" 1
}
wrong "there is no field 'colour'" bar --field colour
wrong "choose one" bar --field stress
wrong "none called 'q'" bar --field stress --component q
wrong "was not written; these were: 0, 20, 40" bar --field damage --step 7
wrong "the run wrote states from the time 0 to " bar --field damage --time 1e9
wrong "time -1: the run wrote states from the time 0 to " bar --field damage --time=-1
wrong "should end in .png, .svg or .pdf" bar --output picture.gif
wrong "there is no such file" nowhere
wrong "has no column 'q'" bar --curve end.q:end.x
wrong "should be 'watch.column : watch.column'" bar --curve x:y
wrong "should be 'watch.column : watch.column'" bar flat other --curve x:y
wrong "two numbers" bar --range 3
wrong "is not a result file" bar.yaml
wrong "is not below the highest" bar --range 3:3
wrong "should be x, y or xy" bar --curve end.x:end.y --log z
wrong "leave out --step" bar --movie bar.mp4 --step 0
wrong "movies end in .mp4" bar --field damage --movie bar.avi
wrong "the result file holds no bars: the deck has none ('bars')" bar --bars stress
wrong "bars have no 'colour' in the result file; it holds strain, stress, force, dissipated, slip, bond stress of them" steel --bars colour
"$breccia" modes bar.yaml --count 1 --output modes > out 2>&1 || fail "modes: $(cat out)"
wrong "modes of vibration are written without bars; draw a field, like displacement, or bars of a run" modes --bars stress
wrong "--field: a picture of bars has no use for it; leave it out" steel --bars stress --field damage
for option in "--component xx" "--deformed 5" "--view 0:20" "--inside 0:1,:" "--broken-bonds" "--size 300" "--movie a.mp4" "--range each"; do
  # shellcheck disable=SC2086 # two words
  wrong "${option%% [x05am3-]*}: a curve over the length of bars has no use for it; leave it out" steel --bars stress --over-length $option
done
for option in "--field damage" "--bars stress" "--step 0" "--time 1" "--deformed 5"; do
  # shellcheck disable=SC2086
  wrong "${option% *}: a curve of histories has no use for it; leave it out" steel --energy $option
done
wrong "--log: a picture of a field has no use for it; leave it out" steel --log x
wrong "--overlay: a picture of bars has no use for it; leave it out" steel --bars stress --overlay a.csv
wrong "--rate: is of movies; leave it out, or give --movie" steel --rate 5
wrong "--over-length needs --bars COLUMN" steel --over-length
wrong "there is no bar 'cross'" steel --bars stress --over-length --of-bars along,cross
wrong "expected names of bars with commas between them" steel --bars stress --over-length --of-bars ,
wrong "'0,,1' should be numbers with commas between them" steel --bars stress --over-length --time 0,,1
wrong "the run wrote states from the time 0 to 1 only" steel --bars stress --over-length --time 0,2
wrong "are drawn at up to 6 times, and these are 7" steel --bars stress --over-length --time 0,0,0,0,0,0,0
wrong "are drawn at up to 6 times, and these are 64" steel --bars stress --over-length --time "$(printf '0,%.0s' $(seq 99))0"
wrong "inside: no bar stands in this shape" steel --bars stress --inside 0:0.1,:
wrong "cannot share an axis" bar --curve "end.time : end.x, pull.value"
wrong "no history of energies" clay --energy
finish

# Closed pipes and curves without gnuplot: one line, everything else written, never a silent end.
. "$(dirname "$0")/common.sh"
cd "$work"

# one_line WHAT STATUS WORDS FILE: the command just run ended with this status and said this in one line of FILE
one_line() {
  equal "$1: status" "$status" "$2"
  contains "$1" "$(cat "$4")" "$3"
  equal "$1: lines" "$(wc -l < "$4")" 1
}

mkdir none half error silent
for name in bash cat ls; do ln -s "$(command -v $name)" none/; done
printf '#!/bin/sh\nexit 3\n' > half/gnuplot               # dies before it has read anything
printf '#!/bin/sh\necho "line 0: no such terminal" >&2\nexit 1\n' > error/gnuplot
printf '#!/bin/sh\nexit 0\n' > silent/gnuplot
chmod +x */gnuplot

# Ten thousand points are more than a pipe holds.
test=(material --model elastic --set "Young modulus=30 GPa" --set "Poisson ratio=0.2" --test uniaxial --to 0.01 --steps 10000)
"$breccia" "${test[@]}" --output whole.csv || fail "the test does not run"

for how in none half error silent; do
  rm -f out.csv curve.png
  PATH="$work/$how" "$breccia" "${test[@]}" --picture curve.png --output out.csv > out 2> errors
  status=$?
  case $how in
  none) words="gnuplot, which is not installed: install it (Debian: apt install gnuplot-nox)" ;;
  half) words="curve.png: not drawn: gnuplot ended with status 3" ;;
  error) words="curve.png: not drawn: gnuplot ended with status 1: line 0: no such terminal" ;;
  silent) words="curve.png: not drawn: gnuplot ended without a picture" ;;
  esac
  one_line "material, gnuplot $how" 1 "$words" errors
  cmp -s out.csv whole.csv || fail "material, gnuplot $how: the rows are not written"
  ls | grep -q 'curve.png' && fail "material, gnuplot $how: half a picture is left"
done

# A parent that neither ignores SIGPIPE nor wants to end by it
cat > fit.yaml <<'Y'
units: {length: m, force: kN, time: s}
material: {model: elastic-1d, density: 1, Young modulus: 3 GPa}
test: {kind: uniaxial, strain: 0.01, steps: 10}
against: points.csv
fit: {Young modulus: {from: 1e6, to: 1e7}}
Y
printf '0,0\n0.005,10000\n0.01,20000\n' > points.csv
PATH="$work/none" "$breccia" calibrate fit.yaml --picture fit.png > out 2> errors; status=$?
one_line "calibrate without gnuplot" 1 "not installed" errors
contains "calibrate without gnuplot" "$(cat out)" "Young modulus"

# A run draws last; what it cannot draw is a warning, said once.
"$breccia" new plate.yaml > /dev/null
cat >> plate.yaml <<'Y'
pictures:
  - {curve: "opening.opening : grip.y"}
  - {curve: "energy.time : energy.kinetic"}
  - {field: damage}
Y
awk '/^pictures:/ && seen++ {next} 1' plate.yaml > once.yaml
PATH="$work/none" "$breccia" run once.yaml --steps 50 > out 2> errors; equal "run without gnuplot: status" $? 0
contains "run without gnuplot" "$(cat errors)" "warning: curves are drawn by gnuplot"
equal "run without gnuplot: said once" "$(grep -c gnuplot errors)" 1
for file in results.vtkhdf summary.json energy.csv; do [ -e "once/$file" ] || fail "run without gnuplot: no $file"; done
PATH="$work/none" "$breccia" plot once --curve "energy.time : energy.kinetic" > out 2> errors; status=$?
one_line "plot without gnuplot" 1 "not installed" errors

# Words of a title are words, and no commands.
"$breccia" plot once --curve "energy.time : energy.kinetic" --title "it's \`touch stolen\` 'so'" --output "a 'curve'.svg" > out 2>&1
equal "plot with quotes: status" $? 0
[ -s "a 'curve'.svg" ] || fail "plot with quotes: no picture: $(cat out)"
[ -e stolen ] && fail "a title runs commands"
grep -q '`touch stolen`' "a 'curve'.svg" || fail "plot with quotes: the title is changed"

# Whoever stops reading ends nothing.
"$breccia" "${test[@]}" 2> errors | head -1 > out; status=${PIPESTATUS[0]}
equal "rows into head: status" "$status" 0
[ -s errors ] && fail "rows into head: it complains: $(cat errors)"
"$breccia" run once.yaml --steps 50 --output headed 2> errors | true; status=${PIPESTATUS[0]}
equal "run into a closed pipe: status" "$status" 0
[ -e headed/summary.json ] || fail "run into a closed pipe: no results"
"$breccia" run once.yaml --steps 50 --output shut 2> errors >&-; equal "run with its output closed: status" $? 0
"$breccia" plot shut --curve "energy.time : energy.kinetic" --output shut.png > out 2>&1 || fail "run with its output closed: its files are damaged: $(cat out)"
# What is said to a closed output lands in no file that took its number.
"$breccia" material --model elastic-1d --set "Young modulus=1" --test uniaxial --to 1 --steps 2 --output soft.csv 2> errors; equal "a soft bar: status" $? 0
contains "a soft bar" "$(cat errors)" "warning: "
"$breccia" material --model elastic-1d --set "Young modulus=1" --test uniaxial --to 1 --steps 2 --output shut.csv 2>&-; equal "with errors closed: status" $? 0
cmp -s shut.csv soft.csv || fail "with errors closed: the file is $(cat shut.csv)"
if [ -w /dev/full ]; then
  "$breccia" "${test[@]}" > /dev/full 2> errors; status=$?
  one_line "a full disk" 1 "not everything could be printed: No space left on device" errors
fi
finish

#!/bin/bash
# Strikes the plate with three formulations and writes the table and pictures of README.md (ten seconds of a processor).
#   report.sh                run everything, then write
#   report.sh --only-write   write from the results that are there
. "$(dirname "$0")/../common.sh"

formulations="ordinary bond-based correspondence"
near=20 far=50 # mm beyond the lower notch, where the crack is looked for
# Watches of particles one by one, in the rows at these distances.
rows() {
  for distance in $near $far; do
    for x in $(seq 50 95); do
      echo "  row-$distance-$x: {every: 2, damage of: {inside: {box: {from: [$x mm, $((74 - distance)) mm], to: [$((x + 1)) mm, $((75 - distance)) mm]}}}}"
    done
  done
}
if [ "${1:-}" != --only-write ]; then
  for name in $formulations; do
    { sed '/^results:/,$d' "struck-$name.yaml"; rows; echo; sed -n '/^results:/,$p' "struck-$name.yaml"; } > "$work/struck.yaml"
    "$breccia" run "$work/struck.yaml" --output "struck-$name" --quiet
  done
fi

# Where the crack crosses a row, mean of what lost a third of its bonds and more, in mm; and when, in µs.
crossing() { for x in $(seq 50 95); do echo "$x $(tail -1 "struck-$1/row-$2-$x.csv" | cut -d, -f4)"; done | awk '$2 > 0.33 {s += $2 * ($1 + 0.5); n += $2} END {print s / n}'; }
passing() { for x in $(seq 50 95); do awk -F, 'NR > 1 && $4 > 0.33 {print $2 * 1000; exit}' "struck-$1/row-$2-$x.csv"; done | sort -g | head -1; }
angle() { awk -v a="$(crossing "$1" $near)" -v b="$(crossing "$1" $far)" -v h=$((far - near)) 'BEGIN {printf "%.0f°", atan2(h, b - a) * 180 / 3.14159265}'; }
chord() { awk -v a="$(crossing "$1" $far)" -v h=$far 'BEGIN {printf "%.0f°", atan2(h, a - 50) * 180 / 3.14159265}'; }
speed() {
  awk -v a="$(crossing "$1" $near)" -v b="$(crossing "$1" $far)" -v h=$((far - near)) -v s="$(passing "$1" $near)" -v t="$(passing "$1" $far)" \
    'BEGIN {printf "%.0f m/s", sqrt(h * h + (b - a) ^ 2) / (t - s) * 1000}'
}
first_break() { sed -n 's/.*"first_broken_bond": {"step": [0-9]*, "time": \([^,]*\),.*/\1/p' "struck-$1/summary.json"; }
line() { # line WORDS PUBLISHED COMMAND...
  printf '| %s | %s |' "$1" "$2"
  for name in $formulations; do printf ' %s |' "$("${@:3}" "$name")"; done
  echo
}
joules() { number "$(summary "struck-$2" "$1")" "%.1f"; }
first() { number "$(first_break "$1")" "%.1f µs" 1000; }
balance() { number "$(summary "struck-$1" imbalance)" "%.0g %%" 100; }
{
  echo "| | published | ordinary | bond-based | correspondence |"
  echo "|---|---|---|---|---|"
  line "angle of the crack, tip of the notch to $far mm beyond it" "70°" chord
  line "the same from $near to $far mm" "" angle
  line "first broken bond" "" first
  line "speed of the crack between these" "" speed
  line "fracture energy (J)" "" joules fracture
  line "energy put in (J)" "" joules external
  line "imbalance of energies" "" balance
} | between computed README.md

mkdir -p pictures
for name in $formulations; do cp "struck-$name/pictures/damage.png" "pictures/$name.png"; done

#!/bin/bash
# Runs the plate with bonds, with and without surface correction, and by correspondence, and writes the table and pictures of README.md.
#   report.sh          run everything (about three minutes on two cores), then write
#   report.sh --only-write   write from the results that are there
. "$(dirname "$0")/../common.sh"
if [ "${1:-}" != --only-write ]; then
  "$breccia" run brittle.yaml --quiet
  sed 's/surface correction: energy/surface correction: none/' brittle.yaml > "$work/brittle.yaml"
  "$breccia" run "$work/brittle.yaml" --output brittle-none --quiet
  "$breccia" run ../plate-with-crack/elastic.yaml --output correspondence --quiet
fi
# Value of a column at the first row whose other column is at least something.
first() { awk -F, -v w="$2" -v c="$3" -v l="$4" 'NR > 1 && $c >= l {print $w; exit}' "$1"; }
severed() { t=$(first "$1/top.csv" 2 4 0.02); if [ -n "$t" ]; then printf "%.4f" "$t"; else echo "not by 0.092"; fi; }
first_break() { sed -n 's/.*"first_broken_bond": {"step": [0-9]*, "time": \([^,]*\),.*/\1/p' "$1/summary.json"; }
broken() { summary "$1" broken_bonds; }
width() { printf "%.4f" "$(first "$1/mouth.csv" 3 2 "$2")"; }
# Opening of the crack at 0.02 s over that by correspondence.
opened() { awk -v a="$(width "$1" 0.02)" -v b="$(width correspondence 0.02)" 'BEGIN {printf "%.2f", (a - 0.06) / (b - 0.06)}'; }
toughness() { awk 'BEGIN {printf "%.1f", 6 * 150000 * 3.015 * 0.03 * 0.05 ^ 2 / 5}'; }
row() { echo "| $1 | $($2 correspondence ${3:-}) | $($2 brittle-none ${3:-}) | $($2 brittle ${3:-}) |"; }
{
  echo "| | correspondence | bonds | bonds, surfaces corrected |"
  echo "|---|---|---|---|"
  row "crack width at the mouth at 0.01 s (m; 0.06 at the start)" width 0.01
  row "the same at 0.02 s" width 0.02
  row "opening at 0.02 s over that by correspondence" opened
  row "first bond breaks (s)" first_break
  row "plate severed (s)" severed
  row "bonds broken by 0.092 s" broken
  row "energy imbalance (%)" imbalance
  echo
  echo "A critical stretch of 0.05 stands for a fracture energy of 6 E δ s₀² / 5 = $(toughness) kN/m in the bulk."
} | between computed README.md
mkdir -p pictures
for run in correspondence brittle-none brittle; do
  "$breccia" plot $run --field damage --time 0.0912 --range 0:1 --output pictures/$run.png > /dev/null
done
ls -l pictures | awk '$5 > 150000 {print $9 " is larger than 150 kB"; bad = 1} END {exit bad}'

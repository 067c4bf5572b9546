#!/bin/bash
# Runs all decks of this example and its variants of control, and writes the table and the pictures of README.md.
#   report.sh                  run everything inside the program (about six minutes on two cores), then write; the column of OpenSees stays
#   report.sh --with-opensees  run the plate of clay in OpenSees too (a quarter of an hour more)
#   report.sh --only-write     write from the results that are there
. "$(dirname "$0")/../common.sh"

variant() { # variant DECK NAME CONTROL
  sed "s/zero-energy control: {silling: 0.1}/zero-energy control: {$3}/" "$1.yaml" > "$work/$1.yaml"
  "$breccia" run "$work/$1.yaml" --output "$1-$2" --quiet || [ $? = 1 ] # a run that the program stops is told in the table
}
if [ "${1:-}" != --only-write ]; then
  for deck in clay elastic; do
    "$breccia" run $deck.yaml --quiet
    variant $deck none "none: yes"
    variant $deck one "silling: 1"
  done
  "$breccia" run rest.yaml --quiet
  "$breccia" run static.yaml --quiet
fi
[ "${1:-}" != --with-opensees ] || "$breccia" run clay-opensees.yaml --quiet

# Value of a column at the first row whose other column is at least something.
#   first FILE WANTED COLUMN LEAST        columns by number
first() { awk -F, -v w="$2" -v c="$3" -v l="$4" 'NR > 1 && $c >= l {print $w; exit}' "$1"; }
last() { tail -1 "$1" | cut -d, -f"$2"; }
# Load when the opening passes 0.05 mm; the ramp is linear over 0.02 s.
onset() { number "$(first "$1/$2.csv" 2 4 0.00005)" "%.0f" "$(awk -v p="$3" 'BEGIN {print p / 0.02}')"; }
outcome() {
  case $(summary "$1" completed) in
    true) echo "to its end" ;;
    *) echo "stopped at $(number "$(summary "$1" time)" "%.4f") s: energy from nothing" ;;
  esac
}
opening() { number "$(first "$1/$2.csv" 3 2 "$3")" "%.4f"; }
severed() { t=$(first "$1/top.csv" 2 4 0.02); [ -n "$t" ] && number "$t" "%.4f s" || echo "not by 0.092 s"; }
# Largest distance from the hyperbola while the strain grows, in kPa.
backbone() {
  awk -F, 'NR > 1 {g = $15; t = $16; if (g < last) exit; last = g; e = t - 60000 * g / (1 + g / 5.0251256e-4); if (e < 0) e = -e
                   if (e > worst) worst = e; top = g} END {printf "%.2f (up to a strain of %.2g)", worst, top}' "$1"
}
straight() { awk -F, 'NR > 1 && $4 > worst {worst = $4} END {print (worst == 0 ? "yes: no bond broken that does not reach within 2 spacings of its line" : "no, damage " worst " beside it")}' "$1/beside.csv"; }
first_break() { sed -n 's/.*"first_broken_bond": {"step": [0-9]*, "time": \([^,]*\),.*/\1/p' "$1/summary.json"; }
# Largest difference between the curves of two runs up to a time, over the largest value of each column. Energies are left out: some are
# roundings only.
apart() {
  for file in mouth middle top beside point-m point-n; do
    paste -d, "$1/$file.csv" "$2/$file.csv" | awk -F, -v until="$3" '
      NR > 1 {n = NF / 2; for (k = 1; k <= n; ++k) {a = $k < 0 ? -$k : $k; d = $k - $(k + n); if (d < 0) d = -d
        if (a > top[k]) top[k] = a; if (d > most[k] && $2 <= until + 1e-9) most[k] = d}}
      END {for (k = 1; k <= n; ++k) if (top[k] > 0) print most[k] / top[k]}'
  done | sort -g | tail -1 | awk '{printf "%.0e", $1}'
}
difference_to_opensees() {
  echo "$(apart clay clay-opensees "$(first_break clay)") until the first bond breaks, $(apart clay clay-opensees 0.06) until 0.06 s, $(apart clay clay-opensees 0.092) until the end"
}
# The same figure of the run in OpenSees, if there is one that came to its end; else what the page has.
in_opensees() { grep -qs '"completed": true' clay-opensees/summary.json && "$@" || echo "not run"; }

{
  echo "| figure | published | computed | law in OpenSees |"
  echo "|---|---|---|---|"
  echo "| clay: load at which the crack begins to open (kN/m³) | 126 | $(onset clay mouth 750) at the mouth, $(onset clay middle 750) in the middle of the crack (0.05 mm) | $(in_opensees onset clay-opensees mouth 750), $(in_opensees onset clay-opensees middle 750) |"
  echo "| elastic: the same | 1400 | $(onset elastic mouth 5000) at the mouth, $(onset elastic middle 5000) in the middle |  |"
  echo "| clay: crack width at 750 kN/m³ (m; 0.06 at the start) | 0.0628 | $(opening clay mouth 0.02) at the mouth, $(opening clay middle 0.02) in the middle (0.02 s) | $(in_opensees opening clay-opensees mouth 0.02), $(in_opensees opening clay-opensees middle 0.02) |"
  echo "| elastic: crack width at 750 kN/m³ (m) | 0.0600 | $(opening elastic mouth 0.003) at the mouth, $(opening elastic middle 0.003) in the middle (0.003 s) |  |"
  echo "| elastic: plate severed | by 0.0912 s | $(severed elastic) |  |"
  echo "| elastic: crack runs straight on | yes | $(straight elastic) |  |"
  echo "| clay: crack does not run through by 0.0792 s | does not | severed: $(severed clay); first bond breaks at $(first_break clay) s | severed: $(in_opensees severed clay-opensees); first at $(in_opensees first_break clay-opensees) s |"
  echo "| clay: backbone followed, point m (distance from the hyperbola, kPa; one chord is 1.5) | yes | $(backbone clay/point-m.csv) | $(in_opensees backbone clay-opensees/point-m.csv) |"
  echo "| clay: the same, point n | yes | $(backbone clay/point-n.csv) | $(in_opensees backbone clay-opensees/point-n.csv) |"
  echo "| elastic at rest at 500 kN/m³: opening of the mouth (mm) | 3.34 (finite elements) | $(number "$(last rest/mouth.csv 4)" "%.3f" 1000) |  |"
  echo "| elastic, the same in equilibrium by the static solver (mm) | 3.34 (finite elements) | $(number "$(last static/mouth.csv 4)" "%.3f" 1000); $(awk -v a="$(last static/mouth.csv 4)" -v b="$(last rest/mouth.csv 4)" 'BEGIN {d = a / b - 1; d = d < 0 ? -d : d; if (d < 1e-8) print "less than 1e-8"; else printf "%.0e", d}') of it from the one at rest |  |"
  echo "| clay: bonds broken by 0.092 s | | $(summary clay broken_bonds) | $(in_opensees summary clay-opensees broken_bonds) |"
  echo "| clay: largest difference of any curve, of its largest value | | | $(in_opensees difference_to_opensees) |"
  echo
  echo "Variants of zero-energy control (Silling's, strength G_s):"
  echo
  echo "| | none | 0.1 | 1 |"
  echo "|---|---|---|---|"
  echo "| elastic: first bond breaks (s) | $(first_break elastic-none) | $(first_break elastic) | $(first_break elastic-one) |"
  echo "| elastic: severed | $(severed elastic-none) | $(severed elastic) | $(severed elastic-one) |"
  echo "| clay: crack width at the mouth at 0.02 s (m) | $(opening clay-none mouth 0.02) | $(opening clay mouth 0.02) | $(opening clay-one mouth 0.02) |"
  echo "| clay: crack width at the mouth at 0.0792 s (m) | $(opening clay-none mouth 0.0792) | $(opening clay mouth 0.0792) | $(opening clay-one mouth 0.0792) |"
  echo "| clay: bonds broken by 0.092 s | $(summary clay-none broken_bonds) | $(summary clay broken_bonds) | $(summary clay-one broken_bonds) |"
  echo "| clay: the run | $(outcome clay-none) | $(outcome clay) | $(outcome clay-one) |"
  echo "| clay: severed | $(severed clay-none) | $(severed clay) | $(severed clay-one) |"
  echo "| elastic: energy imbalance (%) | $(imbalance elastic-none) | $(imbalance elastic) | $(imbalance elastic-one) |"
} | awk -F'|' -v OFS='|' 'NR == FNR {if (!($2 in known)) known[$2] = $5; next} $5 ~ /not run/ {$5 = known[$2] ? known[$2] : " not run "} {print}' README.md - | between computed README.md

mkdir -p pictures
for deck in clay elastic; do
  top=30; [ $deck = elastic ] && top=2000
  times="0.036 0.048 0.0792"; [ $deck = elastic ] && times="0.036 0.074 0.0912"
  for time in $times; do
    "$breccia" plot $deck --field "octahedral shear stress" --time $time --range 0:$top --output pictures/$deck-$time.png > /dev/null
  done
done
"$breccia" plot clay --field damage --time 0.0792 --range 0:1 --output pictures/clay-damage.png > /dev/null
"$breccia" plot clay elastic --curve "mouth.distance : pull.value" --title "Load against crack width at the mouth, until 0.02 s" \
  --range 0.0598:0.066   --output pictures/opening-against-load.png > /dev/null
seq 0 1000 | awk '{g = 0.1 * ($1 / 1000) ^ 3; if ($1 % 25 == 0) printf "%g,%g\n", g, 60000 * g / (1 + g / 5.0251256e-4)}' > backbone.csv
"$breccia" plot clay --curve "point m.octahedral shear strain : point m.octahedral shear stress" --overlay backbone.csv \
  --title "Octahedral shear stress and strain next to the tip, and the backbone" --range 0:0.12 --output pictures/backbone.png > /dev/null
rm backbone.csv
ls -l pictures | awk '$5 > 150000 {print $9 " is larger than 150 kB"; bad = 1} END {exit bad}'

#!/bin/bash
# Runs the beam with three spacings and the beams that were measured, and writes the tables and pictures of README.md.
#   report.sh                run everything (some minutes on two cores), then write
#   report.sh --only-write   write from the results that are there
. "$(dirname "$0")/../common.sh"

spacings="10 5 2.5" # mm
folder() { if [ "$1" = 5 ]; then echo beam; else echo "beam-$1mm"; fi; }
if [ "${1:-}" != --only-write ]; then
  for spacing in $spacings; do
    sed "s/spacing: 5 mm/spacing: $spacing mm/" beam.yaml > "$work/beam.yaml"
    "$breccia" run "$work/beam.yaml" --output "$(folder $spacing)" --quiet
  done
fi

peak() { awk -F, 'NR > 1 && $4 > most {most = $4} END {printf "%.3f", most}' "$(folder $1)/beam.csv"; }
last() { tail -1 "$(folder $1)/$2.csv" | cut -d, -f"$3"; }
share() { awk -v a="$(summary beam "$1")" -v b="$(summary beam external)" 'BEGIN {printf "%.2g %%", 100 * a / b}'; }
plain() { awk 'BEGIN {printf "%.2f", 4 * 3e3 * 0.1 * 0.05 ^ 2 / 6 / 0.44}'; } # kN, without notch: 4 M / L, M = f_t b h^2 / 6
{
  echo "| spacing | peak load | opening of the notch at the end | load left | work of the jack |"
  echo "|---|---|---|---|---|"
  for s in $spacings; do
    echo "| $s mm | $(number "$(peak $s)" %.2f) kN | $(number "$(last $s mouth 4)" %.2f 1000) mm | $(number "$(last $s beam 4)" %.2f) kN |" \
      "$(number "$(summary "$(folder $s)" external)" %.3f 1000) J |"
  done
  echo
  echo "The peak load is $(awk -v a="$(peak 5)" -v b="$(plain)" 'BEGIN {printf "%.1f", a / b}') times the $(plain) kN of a beam that breaks at its strength, and moves by" \
    "$(awk -v a="$(peak 5)" -v b="$(peak 2.5)" 'BEGIN {printf "%.1f", 100 * (a > b ? a - b : b - a) / a}') % from 5 to 2.5 mm. With 5 mm the kinetic energy"
  echo "at the end is $(share kinetic) of the work and \`damping\` has taken $(share damping) of it: the jack moves slowly enough at 10 mm/s."
} | between computed README.md

mkdir -p pictures
cp beam/pictures/bond-damage.png pictures/crack.png
cp beam/pictures/beam-over-mouth.png pictures/load-opening.png

PYTHONPATH=.. python3 -B measured.py "$@"

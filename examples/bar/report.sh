#!/bin/bash
# Varies how fast the bar is loaded and how it is damped, and writes the two tables of docs/choosing.md that show it (half a minute).
. "$(dirname "$0")/../common.sh"
page=../../docs/choosing.md
period=$(awk 'BEGIN {print 4 * 1 / sqrt(30e9 / 2400)}') # 4 L / sqrt(E / density), s
static=                                                 # end displacement at rest, m

# Displacements of the end, every step: time in periods, displacement.
#   pull HISTORY END SOLUTION      HISTORY of the load ('' for sudden), END of the run in periods, further keys of 'explicit'
pull() {
  sed "s/, history: {ramp to: 5.66 ms}/${1:+, history: {$1\}}/; s/end time: 12 ms/end time: $(awk -v n="$2" -v t="$period" 'BEGIN {print n * t}')${3:+, $3}/
       /^pictures:/,\$d" bar.yaml > "$work/varied.yaml"
  "$breccia" run "$work/varied.yaml" --quiet
  awk -F, -v t="$period" 'NR > 1 {print $2 / t, $3}' "$work/varied/end.csv"
}
# Largest displacement over the static one.
largest() { awk -v s="$static" '$2 > most {most = $2} END {print most / s}'; }
beyond() { # beyond PERIODS: a load that grows for so long
  local history=
  [ "$1" = 0 ] || history="ramp to: $(awk -v n="$1" -v t="$period" 'BEGIN {printf "%.6g ms", 1000 * n * t}')"
  pull "$history" "$(awk -v n="$1" 'BEGIN {print n + 5}')" "" | largest | awk '{x = 100 * ($1 - 1); printf x < 5 ? "%.1f %%" : "%.0f %%", x}'
}
# Time until a suddenly loaded bar stays within a hundredth of its state at rest, in periods; largest over static displacement.
rest() { awk -v s="$static" '{if ($2 > 1.01 * s || $2 < 0.99 * s) late = $1; if ($2 > most) most = $2} END {printf "%.1f %.2f", late, most / s}'; }

ratio() { awk -v r="$1" -v t="$period" 'BEGIN {printf "damping: {ratio: %g, at: %.6g Hz}", r, 1 / t}'; }
static=$(pull "" 20 "$(ratio 1)" | tail -1 | cut -d' ' -f2)

{
  names="| loading time t / T |" line="|---|" values="| largest displacement beyond the static one |"
  for t in 0 0.5 1 1.5 2.5 5 5.5 10 10.5; do names+=" $t |" line+="---|" values+=" $(beyond $t) |"; done
  echo "$names"; echo "$line"; echo "$values"
} | between "loading time" "$page"
{
  names="| |" line="|---|" after="| at rest after |" most="| largest displacement over the static one |"
  add() { # add NAME SOLUTION
    read -r late top <<< "$(pull "" 25 "$2" | rest)"
    names+=" $1 |" line+="---|" after+=" $late |" most+=" $top |"
  }
  add "mass-proportional: ratio 0.05" "$(ratio 0.05)"
  for r in 0.2 0.5 1 2; do add $r "$(ratio $r)"; done
  for alpha in 0.5 0.8; do add "local $alpha" "local damping: $alpha"; done
  echo "$names"; echo "$line"; echo "$after"; echo "$most"
} | between damping "$page"

# 'breccia why' on results, compared with the summary of the run.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

cat > torn.yaml <<'Y'
title: Torn plate
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [16, 9]}}}}
cracks: [{cut: {line: [[0.8, 0.45], [0.8, 1]]}}]
peridynamics: {formulation: hybrid, space: plane strain, horizon: 1.5 spacings}
failure: {criterion: critical bond stress, bond tensile strength: 20}
loads:
  - {on: {face: x-, layers: 2}, displacement: [0, 0]}
  - {on: {face: x+, layers: 2}, displacement: [0.03, 0.002], history: {ramp to: 1}}
solve: {explicit: {end time: 0.5, time step: 2e-4}}
results: {number: 3}
pictures: []
Y
"$breccia" run torn.yaml --output out > said 2>&1 || fail "the run: $(cat said)"
"$breccia" why out --first 1000000 > all; equal "why: status" $? 0
broken=$(json out/summary.json broken_bonds)
equal "a line for each broken bond" "$(grep -c '^step ' all)" "$broken"
equal "the first line counts them" "$(head -1 all | cut -d' ' -f1)" "$broken"
[ "$broken" -gt 5 ] || fail "only $broken bonds broke"
for cause in "exceeded the limit of 'critical bond stress'"; do contains "causes" "$(head -1 all)" "$cause"; done
equal "causes add up" "$(head -1 all | grep -o '[0-9]\+' | tail -n +2 | awk '{s += $1} END {print s}')" "$broken"
equal "ten bonds by default" "$("$breccia" why out | grep -c '^step ')" "$([ "$broken" -lt 10 ] && echo "$broken" || echo 10)"
equal "each limit is the deck's" "$(grep -o 'limit [^ ]* kPa' all | sort -u)" "limit 20 kPa"
equal "no value below its limit" "$(sed -n 's/.*tension \([^ ]*\) kPa, limit.*/\1/p' all | awk '$1 < 20' | wc -l)" 0
first=$(sed -n 2p all)
pair=$(echo "$first" | sed 's/.*particles \([0-9]*\) and \([0-9]*\) at.*/\1,\2/')
equal "one bond" "$("$breccia" why out --bond "$pair")" "$first"
equal "one bond from its other end" "$("$breccia" why out/results.vtkhdf --bond "${pair#*,},${pair%,*}")" "$first"
contains "the summary agrees" "$(grep first_broken_bond out/summary.json)" "\"particles\": [${pair%,*}, ${pair#*,}]"
contains "the summary tells the cause" "$(grep first_broken_bond out/summary.json)" '"cause": "limit", "criterion": "critical bond stress", "material": "m", "quantity": "tension", "value": '

# A run that is continued after a stop gives the same reasons.
"$breccia" run torn.yaml --output parts --steps 1500 > /dev/null 2>&1
"$breccia" run torn.yaml --output parts --restart > /dev/null 2>&1 || fail "the restart"
"$breccia" why parts --first 1000000 | cmp - all || fail "after a restart other reasons"

# Bonds that soften without breaking: their number and position at the last state, and the same lines after a restart.
cat > soft.yaml <<'Y'
title: Softened strip
units: {length: mm, force: N, time: s}
materials:
  c: &c {model: exponential-softening, density: 2.4e-9, Young modulus: 30000, tensile strength: 3, fracture energy: 0.1}
  w: {<<: *c, tensile strength: 2.7}
body:
  l: &b {material: c, lattice: square, spacing: 5, thickness: 100, shape: {box: {from: [0, 0], to: [40, 30]}}}
  m: {<<: *b, material: w, shape: {box: {from: [40, 0], to: [50, 30]}}}
  r: {<<: *b, shape: {box: {from: [50, 0], to: [90, 30]}}}
peridynamics: {formulation: bond-based, space: plane stress}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {nearest: [2.5, 17.5]}, displacement: [free, 0]}
  - {on: {face: x+, layers: 3}, displacement: [0.04, free], history: {ramp to: 1}}
solve: {static: {increments: 8}}
results: {number: 3}
pictures: []
Y
"$breccia" run soft.yaml --output soft > said 2>&1 || fail "the strip: $(cat said)"
"$breccia" why soft > all
equal "no bond broke" "$(head -1 all)" "0 bonds broke"
past=$(sed -n '2s/ of .*//p' all)
[ "${past:-0}" -gt 20 ] || fail "bonds past their peak: $(cat all)"
contains "softening bonds" "$(sed -n 2p all)" "softening bonds are past their peak at time 1 s, "
equal "ten of the most damaged ones" "$(grep -c '^particles [0-9]* and [0-9]* at \[.*\] mm: damage 0.9[0-9]*, opened by ' all)" 10
equal "in the gap that is the weakest" "$(sed -n 's/^particles.* at \[\([0-9.]*\),.*/\1/p' all | awk '$1 < 35 || $1 > 55' | wc -l)" 0
equal "the most damaged first" "$(sed -n 's/.*damage \([0-9.]*\),.*/\1/p' all | sort -rn | cmp - <(sed -n 's/.*damage \([0-9.]*\),.*/\1/p' all) && echo yes)" yes
equal "none is listed" "$("$breccia" why soft --first 0 | wc -l)" 2
"$breccia" run soft.yaml --output again --steps 4 > /dev/null 2>&1
"$breccia" run soft.yaml --output again --restart > /dev/null 2>&1 || fail "the restart of the strip"
"$breccia" why again | cmp - all || fail "after a restart other softened bonds"

refused() { # WORDS ARGUMENTS...
  local words=$1
  shift
  "$breccia" why "$@" > /dev/null 2> said
  equal "why $*: status" $? 2
  contains "why $*" "$(cat said)" "$words"
}
refused "give a folder of results"
refused "no bond between particles 0 and 140 broke" out --bond 0,140
refused "'3' should be the numbers of two particles with a comma between" out --bond 3
refused "nowhere" nowhere
finish

#!/bin/bash
# Runs the block with the ramp to 40 MPa and with one that stops at 30 MPa, and writes the table and pictures of README.md.
#   report.sh                  run everything inside the program (a quarter of a minute on two cores), then write
#   report.sh --with-opensees  run the block with its law in OpenSees too (some ten minutes more)
#   report.sh --only-write     write from the results that are there
#   report.sh --control        run the strengths of zero-energy control only, and write their table
. "$(dirname "$0")/../common.sh"
# First break by strength of control, with the constant 12E and with 18K: the same strength times 18K / 12E, which is
# 3K / 2E = (3K + G) / 6G.
ratio=$(awk '/shear modulus:/ {G = $3} /bulk modulus:/ {K = $3} END {printf "%.10g", (3 * K + G) / (6 * G)}' block.yaml)
strengths="none 0.05 0.1 0.2"
control() { # control STRENGTH FACTOR: runs the block, and tells when and where its first bond breaks
  if [ "$1" = none ]; then words="none: yes"; else words="silling: $(awk -v s="$1" -v f="$2" 'BEGIN {printf "%.10g", s * f}')"; fi
  sed "s/zero-energy control: {silling: 0.1}/zero-energy control: {$words}/; /^pictures:/,\$d" block.yaml > "$work/control.yaml"
  "$breccia" run "$work/control.yaml" --quiet > /dev/null 2>&1 || [ $? = 1 ] # a run that the program stops is told
  sed -n 's/.*"first_broken_bond": {.*"time": \([^,]*\),.*"at": \[\([^]]*\)\].*/\1 \2/p' "$work/control/summary.json" |
    awk '{gsub(",", ""); printf "%.2f ms at (%g, %g, %g)", 1000 * $1, $2, $3, $4}'
  [ "$(summary "$work/control" completed)" = true ] || printf "; stopped at $(number "$(summary "$work/control" time)" %.2f 1000) ms: energy from nothing"
}
write_control() {
  {
    echo "| strength G_s | first bond breaks with 12E/(πδ⁴), as here | with 18K/(πδ⁴), as elsewhere ($(awk -v r="$ratio" 'BEGIN {printf "%.3f", r}') times 12E) |"
    echo "|---|---|---|"
    for strength in $strengths; do
      here=$(control $strength 1) there="the same"
      [ $strength = none ] || there=$(control $strength "$ratio")
      echo "| $strength | $here | $there |"
    done
  } | between control README.md
}
if [ "${1:-}" = --control ]; then
  write_control
  exit
fi
if [ "${1:-}" != --only-write ]; then
  "$breccia" run block.yaml --quiet
  sed 's/history: {ramp to: 8 ms}/history: {table: [[0, 0], [6 ms, 0.75], [8 ms, 0.75]]}/; s/6.4 ms\]/6.4 ms, 8 ms]/' block.yaml > "$work/block.yaml"
  "$breccia" run "$work/block.yaml" --output block-30 --quiet
  write_control
fi
[ "${1:-}" != --with-opensees ] || "$breccia" run block-opensees.yaml --quiet

# Surfaces of Table 2. Files: a particle's histories (cap parameter in column 3), then its stresses (columns 9 to 14).
surfaces='BEGIN {FS = ","; T = -2068.4; R = 4.43}
function F(i) {return 26614 - 7997.9 * exp(-6.3816e-5 * i) + 0.11 * i}
FNR == NR {k[$1] = $3; next}
FNR > 1 {I = -($9 + $10 + $11); m = -I / 3
  s = sqrt(($9 - m) ^ 2 + ($10 - m) ^ 2 + ($11 - m) ^ 2 + 2 * ($12 ^ 2 + $13 ^ 2 + $14 ^ 2)); cap = k[$1]; t = $2 * 1000}'
# When a particle first meets cut-off and envelope, and when its cap first grows (ms).
order() {
  awk "$surfaces"'
  FNR > 1 && !cut && I <= T + 1e-3 {cut = t}
  FNR > 1 && !env && s >= F(I) * (1 - 1e-7) {env = t}
  FNR > 1 && !grown && cap > before * (1 + 1e-6) && before > 0 {grown = t}
  FNR > 1 {before = cap}
  END {printf "cut-off %s, envelope %s, cap %s", cut ? sprintf("%.2f", cut) : "never", env ? sprintf("%.2f", env) : "never",
    grown ? sprintf("%.2f", grown) : "never"}' "$1/$2-history.csv" "$1/$2.csv"
}
# Largest distance outside the surfaces of p, q and the corner, over the height of the envelope at the cap.
outside() {
  for w in p q corner; do
    awk "$surfaces"'
    FNR > 1 {f1 = s - F(I); f3 = T - I; f2 = I > cap ? sqrt(s * s + ((I - cap) / R) ^ 2) - F(cap) : 0
      f = f1 > f2 ? f1 : f2; f = f > f3 ? f : f3; if (f / F(cap) > most) most = f / F(cap)}
    END {print most + 0}' "$1/$w-history.csv" "$1/$w.csv"
  done | sort -g | tail -1 | awk '{printf "%.2f %%", 100 * $1}'
}
first_break() { sed -n 's/.*"first_broken_bond": {[^}]*"time": \([^,]*\),.*"at": \[\([^]]*\)\].*/\1 s at (\2)/p' "$1/summary.json"; }
row_at() { awk -F, -v t="$3" -v c="$4" 'NR > 1 && $2 >= t - 1e-9 {print $c; exit}' "$1/$2.csv"; }
damages() { printf "%.3f, %.3f" "$(row_at "$1" beside "$2" 3)" "$(row_at "$1" above "$2" 3)"; }
growth() { awk -v x="$(row_at "$1" "$2" "$3" 4)" 'BEGIN {printf "%+.2f", 1000 * x}'; }
# Uniaxial compressive stress of the law at a strain of 0.004 and at 0.02, the critical stretch (MPa).
alone() { sed "s/^test:.*/test: {$1}/" ../materials/cap.yaml > "$work/alone.yaml"; "$breccia" material "$work/alone.yaml"; }
strength() { alone "kind: uniaxial, strain: -$1" | awk -F, 'NR > 1 && $7 < least {least = $7} END {printf "%.1f", -least / 1000}'; }
isotropic() { alone "kind: isotropic, strain: -0.01" | awk -F, 'END {printf "%.3f", $7 / 1000}'; }
# I1 = 3 K (volume strain less what the cap has given) with the cap at I1.
isotropic_closed() {
  awk 'BEGIN {K = 14478996; X = 110320; D = 4.6412e-7; W = 0.42; low = X; high = 3 * K * 0.03
    for (n = 0; n < 200; ++n) {I = (low + high) / 2; if (3 * K * (0.03 - W * (exp(-D * X) - exp(-D * I))) > I) low = I; else high = I}
    printf "%.3f", -I / 3000}'
}
on_envelope() {
  alone "kind: undrained shear, strain: 0.02" | awk -F, 'function F(i) {return 26614 - 7997.9 * exp(-6.3816e-5 * i) + 0.11 * i}
    END {I = -($7 + $8 + $9); m = -I / 3; printf "%.6f", sqrt(($7 - m) ^ 2 + ($8 - m) ^ 2 + ($9 - m) ^ 2 + 2 * ($10 ^ 2 + $11 ^ 2 + $12 ^ 2)) / F(I)}'
}
# A figure of both runs inside the program and of that in OpenSees, which tells no caps.
whole_in_opensees() { grep -qs '"completed": true' block-opensees/summary.json; }
in_opensees() { whole_in_opensees && "$@" || echo "not run"; }
row() { echo "| $1 | $2 | $($3 block "${@:4}") | $($3 block-30 "${@:4}") | $(in_opensees $3 block-opensees "${@:4}") |"; }
row_with_caps() { echo "| $1 | $2 | $($3 block "${@:4}") | $($3 block-30 "${@:4}") | |"; }
# Largest difference between the curves of two runs up to a time, over the largest value of each column.
apart() {
  for file in p q corner width height; do
    paste -d, "$1/$file.csv" "$2/$file.csv" | awk -F, -v until="$3" '
      NR > 1 {n = NF / 2; for (k = 1; k <= n; ++k) {a = $k < 0 ? -$k : $k; d = $k - $(k + n); if (d < 0) d = -d
        if (a > top[k]) top[k] = a; if (d > most[k] && $2 <= until + 1e-9) most[k] = d}}
      END {for (k = 1; k <= n; ++k) if (top[k] > 1e-6) print most[k] / top[k]}'
  done | sort -g | tail -1 | awk '{printf "%.0e", $1}'
}
# The law alone, inside the program and in OpenSees, along the same path: how far it comes, and how far apart the stresses are.
along() {
  { sed -n '1,/^material:/p' ../materials/cap.yaml | sed '$d'; sed -n '/^material:/,/^test/p' ../materials/cap.yaml | sed '$d'; echo "test: {$1}"; } > "$work/home.yaml"
  { echo "units: {length: m, force: kN, time: s}"; sed -n '/^  concrete:/,/^$/p' block-opensees.yaml | sed 's/^  //; s/concrete/material/'; echo "test: {$1}"; } > "$work/away.yaml"
  "$breccia" material "$work/home.yaml" --output "$work/home.csv"
  words=$("$breccia" material "$work/away.yaml" --output "$work/away.csv" 2>&1 || true)
  paste -d, "$work/home.csv" "$work/away.csv" | awk -F, -v words="$words" '
    NR > 1 && $(n = NF / 2) != "" && $(n + 7) != "" {for (k = 7; k <= 12; ++k) {a = $k < 0 ? -$k : $k; d = $k - $(k + n); if (d < 0) d = -d; if (a > top) top = a; if (d > most) most = d}}
    END {if (words != "") {sub(/: OpenSees server: it returned/, ":", words); sub(/ for its point 0/, "", words); print words} else printf "to %.0e", most / top}'
}
{
  echo "| figure | published | ramp to 40 MPa | ramp that stops at 30 MPa | ramp to 40 MPa, law in OpenSees |"
  echo "|---|---|---|---|---|"
  row_with_caps "above the hole (p): first meets (ms)" "cut-off, then envelope, then cap" order p
  row_with_caps "beside the hole (q)" "the same" order q
  row_with_caps "corner of the hole" "" order corner
  row "first bond breaks" "beside the hole" first_break
  row "mean damage beside and above the hole at 6.2 ms" "vertical cracks beside the hole" damages 0.0062
  row "the same at 6.4 ms" "they grow wider" damages 0.0064
  row "the same at 8 ms" "" damages 0.008
  row "growth of the width along x at 5.6 ms (mm)" "the block widens" growth width 0.0056
  row "growth of the height along z at 5.6 ms (mm)" "the block shortens" growth height 0.0056
  row_with_caps "largest distance outside the surfaces" "" outside
  echo
  echo "Pressed along one axis the law yields on its cap and carries $(strength 0.004) MPa at a strain of 0.4 %, $(strength 0.02) MPa at 2 %. The"
  echo "net section, two thirds of the block, reaches these under $(strength 0.004 | awk '{printf "%.1f", $1 * 2 / 3}') and" \
    "$(strength 0.02 | awk '{printf "%.1f", $1 * 2 / 3}') MPa."
  echo
  if whole_in_opensees; then
    echo "The curves of p, q, the corner, width and height inside the program and in OpenSees"
    echo "differ by $(apart block block-opensees 0.002) of the largest value up to 2 ms, $(apart block block-opensees 0.004) up to 4 ms, $(apart block block-opensees 0.006) up to 6 ms and $(apart block block-opensees 0.008) up to 8 ms."
    echo
  fi
  if [ -x ../../.venv/opensees/bin/python ]; then # scripts/opensees.sh
    echo "| the law alone, CapPlasticity of OpenSees against ours | stresses agree | which is right |"
    echo "|---|---|---|"
    echo "| triaxial at 5 MPa, to 2 % and back to 0, three times | $(along "kind: triaxial, strain: -0.02, return strain: 0, cycles: 3, confining pressure: 5000") | both |"
    echo "| one-dimensional to 5 %, back to tension, twice | $(along "kind: oedometer, strain: -0.05, return strain: 0.001, cycles: 2") | both |"
    echo "| biaxial at 1 MPa to 2 %, back to tension, three times | $(along "kind: biaxial, strain: -0.02, return strain: 0.001, cycles: 3, confining pressure: 1000") | both |"
    echo "| shear of constant volume to 2 %, after 5 MPa | $(along "kind: undrained shear, strain: 0.02, confining pressure: 5000") | both |"
    echo "| the same from no stress | $(along "kind: undrained shear, strain: 0.02") | ours: at the end \|s\| / F_e(I₁) is $(on_envelope); OpenSees divides by I₁ − κ, which is 0 |"
    echo "| isotropic to 1 % along each axis | $(along "kind: isotropic, strain: -0.01") | ours: a mean stress of $(isotropic) MPa, in closed form $(isotropic_closed) MPa; OpenSees divides by \|s\|, which is 0 |"
    echo
  fi
} | between computed README.md

mkdir -p pictures
draw() { "$breccia" plot "$1" --field "$2" --time "$3" --view -90:0 --size 330 --output "pictures/$4.png" "${@:5}" > /dev/null; }
for time in 2.8 5.6 6.4; do draw block "deviator norm" "$(awk -v t=$time 'BEGIN {print t / 1000}')" deviator-$time; done
draw block damage 0.0062 damage-6.2 --range each
draw block-30 damage 0.008 damage-30 --range 0:1
# Stress paths in the plane of I1 and |s| (MPa), with envelope, cut-off, and the first and last cap.
for w in p q; do
  awk "$surfaces"' FNR > 1 && t <= 6.4 {print I / 1000, s / 1000, cap}' block/$w-history.csv block/$w.csv > "$work/path.txt"
  last=$(tail -1 "$work/path.txt" | cut -d' ' -f3)
  gnuplot <<END
F(i) = 26.614 - 7.9979 * exp(-0.063816 * i) + 0.11 * i
set terminal pngcairo size 800,520 font "sans,12"
set output "pictures/path-$w.png"
set title "Stress path of particle $w up to 6.4 ms"
set xlabel "I_1, compression positive [MPa]"
set ylabel "|s| [MPa]"
set key outside below Left reverse maxcols 2 samplen 2.5
set grid lc rgb "#dddddd" lw 1 lt 1
set border lc rgb "#333333"
set xzeroaxis lc rgb "#777777" lw 1.2 lt 1
set parametric
set trange [0:1]
set xrange [-8:*]
set yrange [0:*]
k0 = 8.63407; k1 = $last / 1000.0; T = -2.0684; R = 4.43
set arrow from T,0 to T,F(T) nohead lw 1.5 lc rgb "#555555"
plot T + (75 - T) * t, F(T + (75 - T) * t) w l lw 1.5 lc rgb "#555555" title "failure envelope and tension cut-off", \
  k0 + R * F(k0) * sin(pi / 2 * t), F(k0) * cos(pi / 2 * t) w l lw 1.5 dt 2 lc rgb "#21918c" title "cap at first", \
  k1 + R * F(k1) * sin(pi / 2 * t), F(k1) * cos(pi / 2 * t) w l lw 1.5 lc rgb "#c8501e" title "cap at the end", \
  "$work/path.txt" using 1:2 w l lw 2 lc rgb "#3b3f87" title "particle $w"
END
done
ls -l pictures | awk '$5 > 150000 {print $9 " is larger than 150 kB"; bad = 1} END {exit bad}'

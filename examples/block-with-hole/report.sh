#!/bin/bash
# Runs the block with the ramp to 40 MPa and with one that stops at 30 MPa, and writes the table and pictures of README.md.
#   report.sh          run everything (a quarter of a minute on two cores), then write
#   report.sh --only-write   write from the results that are there
set -eu
cd "$(dirname "$0")"
breccia=../../build/release/breccia
if [ "${1:-}" != --only-write ]; then
  $breccia run block.yaml --quiet
  sed 's/history: {ramp to: 8 ms}/history: {table: [[0, 0], [6 ms, 0.75], [8 ms, 0.75]]}/; s/6.4 ms\]/6.4 ms, 8 ms]/' block.yaml > block-30.yaml
  $breccia run block-30.yaml --quiet
  rm block-30.yaml
fi

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
strength() {
  sed 's/^test:.*/test: {kind: uniaxial, strain: -'"$1"'}/' ../materials/cap.yaml > uniaxial.yaml
  $breccia material uniaxial.yaml | awk -F, 'NR > 1 && $7 < least {least = $7} END {printf "%.1f", -least / 1000}'
  rm uniaxial.yaml
}
row() { echo "| $1 | $2 | $($3 block "${@:4}") | $($3 block-30 "${@:4}") |"; }
{
  sed '/^<!-- computed -->$/q' README.md
  echo
  echo "| figure | published | ramp to 40 MPa | ramp that stops at 30 MPa |"
  echo "|---|---|---|---|"
  row "above the hole (p): first meets (ms)" "cut-off, then envelope, then cap" order p
  row "beside the hole (q)" "the same" order q
  row "corner of the hole" "" order corner
  row "first bond breaks" "beside the hole" first_break
  row "mean damage beside and above the hole at 6.2 ms" "vertical cracks beside the hole" damages 0.0062
  row "the same at 6.4 ms" "they grow wider" damages 0.0064
  row "the same at 8 ms" "" damages 0.008
  row "growth of the width along x at 5.6 ms (mm)" "the block widens" growth width 0.0056
  row "growth of the height along z at 5.6 ms (mm)" "the block shortens" growth height 0.0056
  row "largest distance outside the surfaces" "" outside
  echo
  echo "Pressed along one axis the law yields on its cap and carries $(strength 0.004) MPa at a strain of 0.4 %, $(strength 0.02) MPa at 2 %. The"
  echo "net section, two thirds of the block, reaches these under $(strength 0.004 | awk '{printf "%.1f", $1 * 2 / 3}') and" \
    "$(strength 0.02 | awk '{printf "%.1f", $1 * 2 / 3}') MPa."
  echo
  sed -n '/^<!-- end of computed -->$/,$p' README.md
} > README.new
mv README.new README.md

mkdir -p pictures
draw() { $breccia plot "$1" --field "$2" --time "$3" --view -90:0 --size 330 --output "pictures/$4.png" "${@:5}" > /dev/null; }
for time in 2.8 5.6 6.4; do draw block "deviator norm" "$(awk -v t=$time 'BEGIN {print t / 1000}')" deviator-$time; done
draw block damage 0.0062 damage-6.2
draw block-30 damage 0.008 damage-30 --range 0:1
# Stress paths in the plane of I1 and |s| (MPa), with envelope, cut-off, and the first and last cap.
for w in p q; do
  awk "$surfaces"' FNR > 1 && t <= 6.4 {print I / 1000, s / 1000, cap}' block/$w-history.csv block/$w.csv > path.txt
  last=$(tail -1 path.txt | cut -d' ' -f3)
  gnuplot <<END
F(i) = 26.614 - 7.9979 * exp(-0.063816 * i) + 0.11 * i
set terminal pngcairo size 760,480 font "sans,12"
set output "pictures/path-$w.png"
set title "Stress path of particle $w up to 6.4 ms"
set xlabel "I_1, compression positive (MPa)"
set ylabel "|s| (MPa)"
set key bottom right opaque
set parametric
set trange [0:1]
set xrange [-8:*]
set yrange [0:*]
k0 = 8.63407; k1 = $last / 1000.0; T = -2.0684; R = 4.43
set arrow from T,0 to T,F(T) nohead lw 1.5 lc rgb "#555555"
plot T + (75 - T) * t, F(T + (75 - T) * t) w l lw 1.5 lc rgb "#555555" title "failure envelope and tension cut-off", \
  k0 + R * F(k0) * sin(pi / 2 * t), F(k0) * cos(pi / 2 * t) w l lw 1.5 dt 2 lc rgb "#21918c" title "cap at first", \
  k1 + R * F(k1) * sin(pi / 2 * t), F(k1) * cos(pi / 2 * t) w l lw 1.5 lc rgb "#c8501e" title "cap at the end", \
  "path.txt" using 1:2 w l lw 2 lc rgb "#3b3f87" title "particle $w"
END
  rm path.txt
done
ls -l pictures | awk '$5 > 150000 {print $9 " is larger than 150 kB"; bad = 1} END {exit bad}'

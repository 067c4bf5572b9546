# Curves and movies as they are handed to the programs that draw them: whole scripts, written down here from what the histories hold.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
mkdir programs one two
cat > programs/gnuplot <<'Y'
#!/bin/sh
cat > script
cat script >> scripts
printf '</svg> IEND %%%%EOF' > "$(sed -n "s/^set output '\(.*\)'/\1/p" script)"
Y
cat > programs/ffmpeg <<'Y'
#!/bin/sh
cat > frames
for word; do echo "$word"; last=$word; done > words
echo made > "$last"
Y
chmod +x programs/*
PATH="$work/programs:$PATH"

# script ARGUMENTS: the script of a plot is the input, but for the words that all scripts share
script() {
  "$breccia" plot "$@" > out 2> errors || fail "plot $*: $(cat errors)"
  grep -v '^set \(format\|grid\|border\|zeroaxis\|datafile\)' script > found
  cat > wanted
  checks=$((checks + 1))
  diff wanted found > difference || fail "plot $*: $(cat difference)"
}

printf 'step,time (s),x (kN),y (kN)\n0,0,0,0\n10,0.01,2,-1\n20,0.03,4,1\n30,0.04,nan,3\n' > one/grip.csv
printf 'step,time (s),x (kN),y (kN)\n0,0,1,0\n10,0.01,-2,5\n' > two/grip.csv
printf 'step,time (s),distance (m)\n10,0.01,0.001\n15,0.02,0.002\n20,0.03,0.004\n' > one/gap.csv
printf 'x,y\n0.005,1\n# a word\n0.02, 3.5\n' > 'the wall.csv'
# columns differ in colour, folders in dashes, measured points are black circles; what is no number is left out; a little room around
script one two --curve "grip.time : grip.x, -grip.y" --overlay 'the wall.csv' --title "It's one" --output a.svg <<'Y'
$data0 << END
0 0
10 2
30 4
END
$data1 << END
0 -0
10 1
30 -1
40 -3
END
$data2 << END
0 1
10 -2
END
$data3 << END
0 -0
10 -5
END
$data4 << END
5 1
20 3.5
END
set terminal svg size 800,520 font "sans,12"
set output 'a.svg.part'
set title 'It''s one' noenhanced
set xlabel 'Time [ms]' noenhanced
set ylabel 'Grip [kN]' noenhanced
set key outside right top Left reverse samplen 2.5
set xrange [0:40.8]
set yrange [-5.45:4.45]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'one: x' noenhanced, $data1 using 1:2 with lines lw 2 dt 1 lc rgb "#c8501e" title 'one: -y' noenhanced, $data2 using 1:2 with lines lw 2 dt 2 lc rgb "#3b3f87" title 'two: x' noenhanced, $data3 using 1:2 with lines lw 2 dt 2 lc rgb "#c8501e" title 'two: -y' noenhanced, $data4 using 1:2 with points pt 6 ps 1.3 lw 1.5 lc rgb "#000000" title 'the wall' noenhanced
Y
# what gnuplot would refuse with words of its own is not given to it
refused() { # words, folder, curve, options
  local words=$1 folder=$2 curve=$3
  shift 3
  rm -f script
  "$breccia" plot "$folder" --curve "$curve" --output a.svg "$@" > out 2> errors
  equal "$curve $*: status" $? 2
  equal "$curve $*" "$(cat errors)" "a.svg: $words"
  [ -e script ] && fail "$curve $*: gnuplot was asked"
}
mkdir far
printf 'step,time (s),x (kN),y (kN)\n0,-1,1e308,3\n10,1,-1e308,-2\n' > far/grip.csv
refused "not drawn: no point lies in the range from 5 to 6; points lie from 0 to 0.03" one "grip.time : grip.x" --range 5:6
refused "not drawn: no point lies in the range from 0.031 to 0.05; points lie from 0.01 to 0.03" one "grip.time : grip.x" --range 0.031:0.05 --log xy
refused "the range from 0 to 1 does not fit a logarithmic axis; expected one above 0" one "grip.time : grip.x" --range 0:1 --log x
refused "not drawn: its horizontal axis would go from -1e+308 to 1e+308; expected less than 1e+290" one "grip.time : grip.x" --range=-1e308:1e308
refused "not drawn: its vertical axis would go from -1e+308 to 1e+308; expected less than 1e+290" far "grip.time : grip.x"
refused "not drawn: the range from 0.01 to 0.0100000000001 is too narrow; expected more than 1e-07 of its ends" one "grip.time : grip.x" --range 0.01:0.0100000000001
refused "not drawn: there is no point yet, or none that is a number above 0" far "grip.time : grip.y" --log xy
# rows of the same steps; the upright axis reaches over what the range shows
script one --curve "gap.distance : grip.x" --range 0.002:0.01 --log x --output b.png <<'Y'
$data0 << END
1 2
4 4
END
set terminal pngcairo size 800,520 font "sans,12"
set output 'b.png.part'
set title '' noenhanced
set xlabel 'Gap, distance [mm]' noenhanced
set logscale x
set ylabel 'Grip, x [kN]' noenhanced
unset key
set xrange [2:10]
set yrange [3.8:4.2]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'one' noenhanced
Y
# no line leads over a jump of lengths where a stage counts displacements from zero; forces do not jump
cat > stages.yaml <<'Y'
title: "two stages"
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}
body: {bar: {material: m, lattice: line, spacing: 1, area: 1, shape: {box: {particles: [3, 1]}}}}
peridynamics: {formulation: bond-based, space: 1-D, horizon: 1.015 spacings, calibration: uniaxial}
loads: [{on: {nearest: [0.5, 0]}, displacement: [0, 0]}, {name: end, on: {nearest: [2.5, 0]}, displacement: [2, 0], history: {ramp to: 2}}]
solve:
  - {name: first, displacements: zero, static: {increments: 2, end time: 1}}
  - {name: second, displacements: zero, static: {increments: 2, end time: 1}}
watch: {tip: {displacement of: {nearest: [2.5, 0]}, every: 1}, pull: {reaction of: end, every: 1}}
pictures: []
Y
"$breccia" run stages.yaml --output stages > out 2>&1 || fail "stages: $(cat out)"
contains "stages: summary" "$(cat stages/summary.json)" '{"name": "second", "steps": [2, 4], "times": [1, 2], "at_rest": true, "displacements_from_zero": true}'
[ "$(grep -o displacements_from_zero stages/summary.json | wc -l)" = 1 ] || fail "stages: summary: $(grep stages stages/summary.json)"
"$breccia" plot stages --curve "tip.time : tip.x" --output a.svg > out 2> errors || fail "stages: $(cat errors)"
equal "stages: points" "$(sed -n '/^.data0/,/^END/p' script | tr '\n' ';')" '$data0 << END;0 0;0.5 0.5;1 1;;1.5 0.5;2 1;END;'
"$breccia" plot stages --curve "pull.time : pull.x" --output a.svg > out 2> errors || fail "stages: $(cat errors)"
equal "stages: points of a force" "$(sed -n '/^.data0/,/^END/p' script | grep -c '^$')" 0
checks=$((checks + 3))
# several folders and one column: colours tell the folders; a legend of long words lies below; two of one name are told by their paths
mkdir -p "a folder of a longer name" deep
cp two/grip.csv "a folder of a longer name"
cp -r one deep
script one deep/one/ "a folder of a longer name" --curve "grip.step : grip.x" --log y --x-label "Steps 'n all" --output b.pdf <<'Y'
$data0 << END
0 0
10 2
20 4
END
$data1 << END
0 0
10 2
20 4
END
$data2 << END
0 1
10 -2
END
set terminal pdfcairo size 16.5cm,10.7cm font "sans,11"
set output 'b.pdf.part'
set title '' noenhanced
set xlabel 'Steps ''n all' noenhanced
set ylabel 'Grip, x [kN]' noenhanced
set logscale y
set key outside below center Left reverse maxcols 2 samplen 2.5
set rmargin 4
set xrange [0:20.4]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'one' noenhanced, $data1 using 1:2 with lines lw 2 dt 1 lc rgb "#c8501e" title 'deep/one/' noenhanced, $data2 using 1:2 with lines lw 2 dt 1 lc rgb "#21918c" title 'a folder of a longer name' noenhanced
Y
# columns of several watches have no common name at the axis; an axis of one value has room, one that ends at zero ends there
printf 'step,time (s),value (kN)\n0,0,7\n10,0.01,7\n' > one/pull.csv
script one --curve "grip.y : grip.y, pull.value" --y-label '' --output c.svg <<'Y'
$data0 << END
0 0
-1 -1
1 1
3 3
END
$data1 << END
0 7
-1 7
END
set terminal svg size 800,520 font "sans,12"
set output 'c.svg.part'
set title '' noenhanced
set xlabel 'Grip, y [kN]' noenhanced
set ylabel '' noenhanced
set key outside right top Left reverse samplen 2.5
set xrange [-1.08:3.08]
set yrange [-1.4:7.4]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'grip, y' noenhanced, $data1 using 1:2 with lines lw 2 dt 1 lc rgb "#c8501e" title 'pull' noenhanced
Y
script one --curve "pull.time : -pull.value" --output c.svg <<'Y'
$data0 << END
0 -7
10 -7
END
set terminal svg size 800,520 font "sans,12"
set output 'c.svg.part'
set title '' noenhanced
set xlabel 'Time [ms]' noenhanced
set ylabel '-pull [kN]' noenhanced
unset key
set xrange [0:10.2]
set yrange [-7.35:-6.65]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'one' noenhanced
Y
# energies: of the first such file by name, all in its unit that are not nothing throughout
mkdir ledgers
printf 'step,time (s),kinetic (kJ),internal (kJ),dissipated (kJ),external (kJ),imbalance,broken bonds\n0,0,0,0,0,0,0,0\n1,1,1,-2,0,3,0.5,9\n' > ledgers/second.csv
sed 's/,1,-2,0,3,/,4,4,0,8,/' ledgers/second.csv > ledgers/first.csv
printf 'step,time (s),kinetic (kJ)\n0,0,7\n' > ledgers/a.csv
script ledgers --energy --output e.svg <<'Y'
$data0 << END
0 0
1 4
END
$data1 << END
0 0
1 4
END
$data2 << END
0 0
1 8
END
set terminal svg size 800,520 font "sans,12"
set output 'e.svg.part'
set title '' noenhanced
set xlabel 'Time [s]' noenhanced
set ylabel 'First [kJ]' noenhanced
set key outside right top Left reverse samplen 2.5
set xrange [0:1.02]
set yrange [0:8.4]
plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb "#3b3f87" title 'kinetic' noenhanced, $data1 using 1:2 with lines lw 2 dt 1 lc rgb "#c8501e" title 'internal' noenhanced, $data2 using 1:2 with lines lw 2 dt 1 lc rgb "#21918c" title 'external' noenhanced
Y
# points that cannot be read are refused in their line
overlay() { # overlay ROWS WORDS
  printf "$1" > points.csv
  "$breccia" plot one --curve "grip.time : grip.x" --overlay points.csv --output o.svg > out 2> errors
  equal "points «$1»: status" $? 2
  contains "points «$1»" "$(cat errors)" "points.csv$2"
}
overlay 'x,y\n1,2\nx,y\n' ":3: expected x and y with a comma between, and points in the numbers; found 'x,y'"
overlay '1;2\n' ":1: expected x and y"
overlay '1,2\n\n# words\n 3, \n' ":4: expected x and y"
overlay 'x,y\n' ": no row begins with two numbers, x and y with a comma between"

# ---- pictures and words of motions: axes with their names and units, and rows of what an oscillator does that is pushed at once ----
awk 'BEGIN {print "time (s),x (g)"; for (k = 0; k <= 200; ++k) printf "%g,%g\n", k * 0.01, 0.2 * sin(k * 0.2)}' > top.csv
awk 'BEGIN {print "time (s),x (m/s2)"; for (k = 0; k <= 200; ++k) printf "%g,%g\n", k * 0.01, sin(k * 0.2)}' > base.csv
rm -f scripts
"$breccia" spectrum top.csv base.csv --column x > out 2> errors || fail "spectrum: $(cat errors)"
equal "spectrum: pictures" "$(sed -n "s/^set output '\(.*\).part'/\1/p; s/^set title '\(.*\)' noenhanced/ \1/p; s/^set [xy]label '\(.*\)' noenhanced/ \1/p; s/^set logscale/ log/p" scripts)" "$(cat << 'Y'
top-spectrum/acceleration.png
 Acceleration: top
 Time [s]
 Acceleration [m/s²]
top-spectrum/husid.png
 Share of Arias'' intensity that has come: top
 Time [s]
 Husid
top-spectrum/response-spectrum.png
 Response spectrum: top
 Period [s]
 log x
 Pseudo-acceleration [m/s²]
top-spectrum/fourier.png
 Amplitudes of frequencies: top
 Frequency [Hz]
 log x
 Amplitude [m/s]
 log y
top-spectrum/transfer.png
 Transfer function: top over base
 Frequency [Hz]
 log x
 Ratio
Y
)"
equal "spectrum: lines of both" "$(grep '^plot' scripts | grep -o "title '[^']*'" | tr '\n' ' ')" "title 'top' title 'top' title 'top' title 'base' title 'top' title 'base' title 'top' "
# 0.2 g against 1 m/s2 at all frequencies at which both have something
awk -F, 'NR > 1 && $4 != "" && $1 > 1 && $1 < 10 {++n; if ($4 < 1.96 || $4 > 1.963) bad = 1} END {exit bad || n < 20}' top-spectrum/fourier.csv || fail "spectrum: ratios: $(cat top-spectrum/fourier.csv)"
awk 'BEGIN {print "time (s),x (m/s2)"; for (k = 0; k <= 60; ++k) printf "%g,2\n", k}' > push.csv
"$breccia" spectrum push.csv --column x --damping 0.1 > out 2> errors || fail "spectrum of a push: $(cat errors)"
awk 'BEGIN {pi = atan2(0, -1); over = 1 + exp(-pi * 0.1 / sqrt(0.99)); split("0.02 0.05 0.1 0.2 0.3 0.5 0.7 1 1.5 2 3 5 10", period, " ")}
  function near(a, b) {return a > b * 0.997 && a < b * 1.003}
  /^ +period/ {row = 1; next} row && NF == 4 {T = period[row++]; x = over * 2 * (T / (2 * pi)) ^ 2; w = 2 * pi / T
    if ($1 != T || !near($2, x) || !near($3, x * w) || !near($4, x * w * w)) bad = 1}
  END {exit bad || row != 14}' out || fail "spectrum of a push: $(cat out)"
checks=$((checks + 2))
grep -q "^largest acceleration              2 m/s2$" out || fail "spectrum of a push: $(cat out)"
grep -q "^largest velocity                  120 m/s$" out || fail "spectrum of a push: $(cat out)"
grep -q "^largest displacement              3.6e+03 m$" out || fail "spectrum of a push: $(cat out)"
# pi / (2 g) 4 m2/s4 over a minute, of which nine tenths take 54 s
grep -q "^Arias intensity                   38.44 m/s$" out || fail "spectrum of a push: $(cat out)"
grep -q "^significant duration (5 to 95 %)  54 s$" out || fail "spectrum of a push: $(cat out)"

# ---- a run: profiles along an axis in space, and a movie of what fades ----
cat > block.yaml <<'Y'
title: Block
units: {length: m, force: kN, time: s}
materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}
body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 4]}}}}
loads: [{on: {all: yes}, initial velocity: {translation: [1, 0, 0]}}]
solve: {explicit: {end time: 0.034, time step: 1 ms, damping: 300}}
profiles: {wall: {of: {all: yes}, along: x, every: 1}}
results: {number: 34, fields: [velocity]}
pictures: []
Y
sed -i '/^pictures/d' block.yaml
rm -f scripts
"$breccia" run block.yaml > out 2> errors || fail "block: $(cat errors)"
for kind in displacement velocity acceleration shear-strain shear-stress; do
  contains "profiles" "$(cat out)" "  block/pictures/wall-$kind.png"
done
equal "profiles: places" "$(sed -n '2,$s/,.*//p' block/profiles/wall.csv | tr '\n' ' ')" "0.05 0.15 0.25 0.35 0.45 "
equal "profiles: labels" "$(sed -n "s/^set xlabel '\(.*\) \[.*/\1/p" scripts | tr '\n' ';')" \
  "Largest displacement;Largest velocity;Largest acceleration;Largest shear strain;Largest shear stress;"
equal "profiles: height" "$(grep -c "^set ylabel 'X \[m\]' noenhanced" scripts)" 5
equal "profiles: titles" "$(grep -c "^set title 'wall' noenhanced" scripts)" 5
equal "profiles: lines" "$(grep '^plot' scripts | grep -o "rgb \"[^ ]* title '[^']*'" | tr '\n' ';')" "$(for k in displacement velocity acceleration; do
  printf "rgb \"#3b3f87\" title '$k x';rgb \"#c8501e\" title '$k y';rgb \"#21918c\" title '$k z';"; done; printf "rgb \"#3b3f87\" title 'shear strain';rgb \"#3b3f87\" title 'shear stress';")"
# numbers of a picture are those of the file: velocities of at most 1 m/s
equal "profiles: numbers" "$(sed -n "/^set title/q; /^.data0/d; /^END/,\$d; p" script | awk '{print $2}' | tr '\n' ' ')" "0.05 0.15 0.25 0.35 0.45 "

# where there is no folder for them this is said
mkdir full
touch full/profiles
"$breccia" run block.yaml --output full > out 2> errors
equal "no folder for profiles: status" $? 1
equal "no folder for profiles" "$(grep -v ^warning errors)" "full/profiles: it is a file; expected a folder, or a name that is not there yet"

movie() { # movie OPTIONS: made of all states, its words in one line
  "$breccia" plot block --field velocity --size 60 --movie fade.mp4 "$@" > out 2> errors || fail "movie $*: $(cat errors)"
  tr '\n' ' ' < words
}
"$breccia" plot block --field velocity --step last --output one.png > out 2>&1 || fail "picture: $(cat out)"
usual=$(movie)
size=$(grep -x '[0-9]*x[0-9]*' words)
bytes=$((${size%x*} * ${size#*x} * 4))
# 35 states in about ten seconds
equal "movie" "$usual" "-nostdin -y -loglevel error -f rawvideo -pixel_format bgr0 -video_size $size -framerate 4 -i pipe:0 -r 25 -c:v libx264 -crf 20 -pix_fmt yuv420p -movflags +faststart -f mp4 fade.mp4.part "
equal "frames" "$(wc -c < frames)" $((35 * bytes))
mv frames all
equal "a slow movie" "$(movie --rate 9 | grep -o 'framerate .* -c:v')" "framerate 9 -i pipe:0 -r 25 -c:v"
equal "a fast movie" "$(movie --rate 30 | grep -o 'framerate .* -c:v')" "framerate 30 -i pipe:0 -r 30 -c:v"
# colours of each frame by itself: the first and fastest looks the same, the last, which has all but come to rest, does not
movie --range each > out
same() { cmp -s <(tail -c +$((($1) * bytes + 1)) all | head -c $bytes) <(tail -c +$((($1) * bytes + 1)) frames | head -c $bytes); }
same 0 || fail "the first frame has other colours when each has its own"
same 34 && fail "the last frame has the colours of all when each has its own"
checks=$((checks + 2))
sed 's/number: 34/number: 1/' block.yaml > short.yaml
"$breccia" run short.yaml > out 2> errors || fail "short: $(cat errors)"
"$breccia" plot short --field velocity --movie fade.mp4 > out 2> errors || fail "two states make a movie: $(cat errors)"
contains "at least two a second" "$(tr '\n' ' ' < words)" "-framerate 2 -i"
finish

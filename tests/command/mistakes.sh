# Mistakes with files, and what people do to them while they are read and written: nothing of the user's is written over, and what is lost, cannot be
# read or would be read wrongly is said.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
cat > bar.yaml <<'Y'
title: Bar
materials: {m: {model: elastic, Young modulus: 1 GPa, Poisson ratio: 0.2, density: 2000}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [12, 5]}}}}
peridynamics: {space: plane strain}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {face: x+, layers: 3}, velocity: [1 mm/s, free]}
solve: {explicit: {time step: 2e-5, steps: 60}}
watch: {end: {displacement of: {face: x+}, every: 5}, energy: {energy: yes, every: 20}}
results: {number: 2, precision: double, fields: [displacement]}
pictures: []
Y

# refused WHAT WORDS COMMAND ...: it fails with one line that holds the words
refused() {
  local what=$1 words=$2
  shift 2
  timeout 120 "$breccia" "$@" > /dev/null 2> errors
  equal "$what: status" $? 2
  contains "$what" "$(cat errors)" "$words"
  equal "$what: $(cat errors): lines" "$(wc -l < errors)" 1
}

# ---- what is read is not written over ----
mkdir own deck
{ echo '# my notes'; cat bar.yaml; } > deck/deck.yaml
cp deck/deck.yaml kept
refused "results beside a deck of their name" "deck/deck.yaml: was not written by a run" run deck/deck.yaml --output deck
cmp -s deck/deck.yaml kept || fail "a deck was written over by the results"
"$breccia" run bar.yaml --quiet || fail "bar"
"$breccia" run bar/deck.yaml --quiet --output bar || fail "a run cannot be repeated from what it wrote"
{ echo x,y,volume; for i in 0 1 2 3 4 5; do for j in 0 1 2 3 4; do echo "$i,$j,1"; done; done; } > own/end.csv
sed 's/^body:.*/body: {b: {material: m, lattice: square, thickness: 1, spacing: 1, file: end.csv}}/' bar.yaml > own/grains.yaml
cp own/end.csv kept
refused "a history named like the particles" "own/end.csv: is what the deck reads as 'end.csv'" run own/grains.yaml --output own
cmp -s own/end.csv kept || fail "particles were written over by a history"
[ -e own/results.vtkhdf ] && fail "results were written all the same"
"$breccia" run own/grains.yaml --quiet || fail "particles beside the folder of results"
law=(--model elastic-1d --set 'Young modulus=1 GPa')
printf 'strain,stress\n0,0\n0.001,1e6\n' > measured.csv
printf 'strain xx\n0\n0.001\n' > path.csv
printf 'material: {model: elastic, density: 1000, Young modulus: 1 GPa, Poisson ratio: 0}\ntest: {kind: uniaxial, strain: 0.01}\n' > test.yaml
cp measured.csv path.csv test.yaml own
refused "rows over measured points" "measured.csv is read here" material "${law[@]}" --test uniaxial --to 0.001 --against measured.csv --output measured.csv
refused "rows over a path" "path.csv is read here" material "${law[@]}" --strain path.csv --output ./path.csv
refused "rows over a test" "test.yaml is read here" material test.yaml --output test.yaml
for file in measured.csv path.csv test.yaml; do cmp -s $file own/$file || fail "$file was written over"; done

# ---- files that cannot be opened, as there are too many ----
number=3 # at least as many as it takes to begin
until (ulimit -n $number && exec "$breccia" --version) > out 2>&1 || [ $number -gt 30 ]; do number=$((number + 1)); done
sed 's/^title: .*/units: {length: furlong, force: N, time: s}/' bar.yaml > furlong.yaml # in the database of the library of units
(ulimit -n $number && exec "$breccia" run furlong.yaml --quiet --output few) 2> errors
contains "units where files are too many" "$(cat errors)" "Too many open files; close some, or allow more (ulimit -n)"
for number in $number $((number + 1)); do
  (ulimit -n $number && exec "$breccia" run bar.yaml --quiet --output few) 2> errors
  equal "$number files at once: status" $? 1
  contains "$number files at once" "$(cat errors)" "Too many open files"
  equal "$number files at once: lines" "$(wc -l < errors)" 1
done

# ---- warnings and what is told of a run stay in their lines and leave the terminal alone ----
printf 'title: "Ba\\e[31mr"\nmaterials: {"m\\e[32m": {model: elastic, Young modulus: 1 GPa, Poisson ratio: 0.2, density: 2}}\n' > signs.yaml
sed '1,2d; s/material: m/material: "m\\e[32m"/; s/{on: {face: x+/{name: "k\\n\\e[34m", on: {face: x+/; s/1 mm/100000 m/; s/time step: 2e-5, //' bar.yaml >> signs.yaml
signs=$(printf 's\033[36mq.yaml')
cp signs.yaml "$signs"
for verb in check run; do
  "$breccia" $verb "$signs" > out 2> errors
  contains "signs in names, $verb" "$(cat errors)" 'warning: s\x1b[36mq.yaml:2:'
  contains "signs in names, $verb: title" "$(cat out)" 'Ba\x1b[31mr'
  equal "signs in names, $verb: raw ones" "$(cat out errors | tr -d -c '\001-\011\013-\037')" ""
done

# ---- names that become one name of a file ----
for names in 'a b,a-b' 'ä,ö'; do
  sed "s/^watch:.*/watch: {${names%,*}: {energy: yes}, ${names#*,}: {energy: yes}}/" bar.yaml > names.yaml
  refused "histories $names" ".csv, like '${names%,*}'" run names.yaml
done

# ---- files that others touch while a run writes them ----
sed 's/steps: 60/steps: 1000000000/' bar.yaml > long.yaml
for act in 'rm held/end.csv' 'truncate -s 0 held/end.csv' 'sed -i s/step/stp/ held/end.csv'; do
  rm -rf held
  "$breccia" run long.yaml --quiet --output held 2> errors &
  run=$!
  wait_for $run [ -s held/end.csv ]
  $act
  kill -TERM $run
  wait $run
  contains "$act" "$(cat errors)" "held/end.csv: was removed, replaced or changed while the run wrote it"
done

# ---- how to go on is told in words that a shell takes ----
mkdir "my tests"
cp long.yaml 'my tests/it'\''s $long.yaml'
"$breccia" run 'my tests/it'\''s $long.yaml' --output 'my results' --set 'results.number=1' > out 2>&1 &
run=$!
wait_for $run [ -s 'my results/end.csv' ]
kill -TERM $run
wait $run
words=$(sed -n "s/^'breccia \(.*\)' goes on from here\$/\1/p" out)
eval "\"\$breccia\" $words --steps 1 --quiet" > out 2>&1 || fail "$words: $(cat out)"
checks=$((checks + 1))

# ---- a study ends with its cases, whoever is told ----
sed 's/every: 5/every: 100/' long.yaml > cases.yaml
for signal in INT TERM HUP; do
  rm -rf cases-study
  "$breccia" study cases.yaml --vary 'materials.m.density=1000, 2000' --jobs 2 > out 2>&1 &
  study=$!
  both() { [ -s cases-study/density-1000/end.csv ] && [ -s cases-study/density-2000/end.csv ]; }
  wait_for $study both
  kill -$signal $study
  wait $study
  equal "a study told $signal: status" $? 130
  equal "a study told $signal" "$(grep -c ': stopped, ' out)" 2
  for case in 1000 2000; do
    [ -e cases-study/density-$case/run.lock ] && fail "$signal: case $case goes on without its study"
    [ -e cases-study/density-$case/checkpoint.h5 ] || fail "$signal: case $case left no checkpoint"
  done
  checks=$((checks + 2))
done

# ---- what cannot be read is not called damaged ----
cp -r bar unread
rm unread/checkpoint.h5 && mkdir unread/checkpoint.h5
refused "a checkpoint that cannot be read" "unread/checkpoint.h5: cannot be read: Is a directory" run bar.yaml --output unread --restart
rm unread/results.vtkhdf && mkfifo unread/results.vtkhdf
refused "results that are a pipe" "unread/results.vtkhdf: it is a pipe or a device" plot unread --field displacement
# ---- links and pipes in a folder of results lead nowhere ----
rm -rf linked; cp -r bar linked
echo precious > kept
for name in results.vtkhdf results.vtkhdf.part end.csv deck.yaml summary.json; do
  rm -f linked/$name; ln -s ../kept linked/$name
  refused "a link $name" "linked/$name: cannot be written: it is a link; remove it" run bar.yaml --output linked
  rm linked/$name; mkfifo linked/$name
  refused "a pipe $name" "linked/$name: cannot be written: it is a pipe or a device" run bar.yaml --output linked
  rm linked/$name; [ ! -e bar/$name ] || cp bar/$name linked/
done
for name in checkpoint.h5 end.csv results.vtkhdf; do
  mv linked/$name kept-$name; ln -s ../kept-$name linked/$name
  refused "a link $name, restart" "linked/$name: " run bar.yaml --output linked --restart
  rm linked/$name; mv kept-$name linked/$name
done
rmdir linked/pictures 2> /dev/null; rm -rf linked/pictures; mkdir elsewhere; ln -s ../elsewhere linked/pictures
"$breccia" run bar.yaml --output linked --set 'pictures=[{field: displacement}]' > out 2> errors
contains "a link to a folder of pictures" "$(cat errors)" "linked/pictures: the folder cannot be made: it is a link; remove it"
equal "a folder behind a link" "$(ls elsewhere)" ""
equal "a file behind a link" "$(cat kept)" precious

# ---- tables that would be read wrongly ----
zero() { printf "$1" | tr Z '\0' > zero.csv; }
grains='body={b: {material: m, lattice: square, thickness: 1, spacing: 1, file: zero.csv}}'
grains() { refused "$1" "$2" check bar.yaml --set "$grains"; }
zero "$(sed 's/$/\\n/' own/end.csv | tr -d '\n')Z\n9,9,1\n"
grains "a zero byte among particles" "zero.csv: it is not text: it holds a zero byte"
{ echo x,y,volume; echo '0,5,0,5,1,0'; } > zero.csv
grains "decimals with a comma" "zero.csv:2: has 6 cells, but the heading names 3 columns"
{ echo 'x (s),y,volume'; echo '0,0,1'; } > zero.csv
grains "a unit that is none" "zero.csv: 'x (s)' has no unit of length"
{ printf '\xef\xbb\xbf'; sed 's/x,y,volume/x (mm),y (mm),volume (cm3)/' own/end.csv; } > zero.csv
"$breccia" check bar.yaml --set "$(echo "$grains" | sed 's/spacing: 1,/spacing: 1 mm,/')" --set 'solve={explicit: {steps: 5}}' > out 2>&1 || fail "particles in mm: $(cat out)"
contains "particles in mm" "$(cat out)" "body: 6 mm x 5 mm"
zero '0 0\n1 1\nZ2 5\n3 4\n'
history='loads.2={on: {face: x+}, velocity: [1 mm/s, free], history: {file: {name: zero.csv}}}'
refused "a zero byte in a record" "zero.csv: it is not text" check bar.yaml --set "$history"
for row in '0,002;26,4' '2,x' '2'; do
  printf 'x,y\n0,1\n%s\n3,4\n' "$row" > points.csv
  refused "points like $row" "points.csv:3: expected x and y with a comma between" plot bar --curve 'end.time : end.x' --overlay points.csv --output points.png
done
head -1 bar/end.csv > own/end.csv
refused "a curve without a row" "no point" plot own --curve 'end.time : end.x' --output points.png

# ---- arguments that nobody would look at ----
refused "two models" "breccia models: 'j2' is one argument too many" models elastic j2
refused "completion of something" "breccia completion: 'x' is one argument too many" completion x
refused "a schema of something" "breccia schema: 'x' is one argument too many" schema x
refused "help on no verb" "there is no verb 'plto'; did you mean 'plot'?" help plto
refused "a rate in words" "--rate: 'x' is not a number" plot own --rate x
refused "a rate of none" "--rate: '0' is not above 0 and up to 120 written steps a second" plot own --rate 0
refused "a range that is no number" "--range: 'nan:1' should be two numbers with a colon between" plot own --field displacement --range nan:1
refused "a view without an end" "--view: '0:inf' should be two numbers with a colon between" plot own --field displacement --view 0:inf

refused "a part of a picture up to no number" "--inside: 'nan:1,:,:' should be two or three ranges" plot own --field displacement --inside nan:1,:,:
refused "threads that wait for each other" "threads: 1000000 would only wait for each other, as this process may use" run bar.yaml --threads 1000000
refused "more threads than can be counted" "--threads: '2147483648' is not a whole number from 1 to 2147483647" run bar.yaml --threads 2147483648
refused "more modes than a body has" "--count: '2147483648' is not a whole number from 1 to 1000000" modes bar.yaml --count 2147483648
refused "a picture that no file holds" "--size: '2147483648' is not a whole number from 50 to 20000" plot own --field displacement --size 2147483648

# ---- whatever signs names hold, a message is one line that a terminal does not obey ----
line=$(printf 'a\nb\033[31m\377')
seen='a\nb\x1b[31m\xff'
refused "a deck with a newline in its name" "$seen: cannot be read: No such file" run "$line"
refused "a number with a newline" "--steps: '$seen' is not a whole number" run bar.yaml --steps "$line"
refused "a field with a newline" "there is no field '$seen' in the result file" plot bar --field "$line"
refused "a verb with a newline" "there is no verb '$seen'" "$line"
refused "an option with a newline" "unknown option --$seen;" run "--$line"
mkdir "$line"
refused "a folder with a newline in its name" "$seen" plot "$line" --curve 'end.time : end.x'

# ---- what could not be written to its end has no name ----
words=$( (ulimit -S -f 0 && exec "$breccia" new short.yaml) 2>&1 > /dev/null)
equal "a new deck beyond the limit: status" $? 1
contains "a new deck beyond the limit" "$words" "short.yaml: cannot be written: File too large"
[ -e short.yaml ] && fail "half a deck was left"
words=$( (ulimit -S -f 0 && exec "$breccia" material "${law[@]}" --test uniaxial --to 0.001 --output short.csv) 2>&1 > /dev/null)
equal "rows beyond the limit: status" $? 1
contains "rows beyond the limit" "$words" "short.csv: cannot be written: File too large"
[ -e short.csv ] && fail "half a table was left"
finish

# Runs that the system or their own numbers stop: by the processor time or the size of files that are allowed, or because energy comes from
# nothing. What they had written last is good, is told of, and can be taken up.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1
cat > bar.yaml <<'Y'
title: Bar
materials: {m: {model: elastic, Young modulus: 1 GPa, Poisson ratio: 0.2, density: 2000}}
body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [40, 15]}}}}
peridynamics: {space: plane strain}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, free]}
  - {on: {face: x+, layers: 3}, velocity: [1 mm/s, free]}
solve: {explicit: {time step: 2e-5, steps: 100000000}}
watch: {end: {displacement of: {face: x+}, every: 500}}
results: {number: 3, precision: double, checkpoint steps: 20000, fields: [displacement]}
pictures: []
Y

# ---- processor time: the run ends with a checkpoint, as it does by Ctrl-C ----
(ulimit -S -t 1 && exec "$breccia" run bar.yaml --threads 1 --output allowed) > out 2>&1
equal "processor time: status" $? 130
contains "processor time" "$(cat out)" "--restart' goes on from here"
steps=$(json allowed/summary.json steps)
"$breccia" run bar.yaml --quiet --output allowed --restart --steps $((steps + 700)) > out 2>&1 || fail "processor time: $(cat out)"
"$breccia" run bar.yaml --quiet --output whole --steps $((steps + 700)) > out 2>&1 || fail "whole: $(cat out)"
"$build/tests/compare_results" whole/checkpoint.h5 allowed/checkpoint.h5 > out || fail "processor time: checkpoints differ: $(cat out)"
cmp -s whole/end.csv allowed/end.csv || fail "processor time: histories differ"
checks=$((checks + 2))

# ---- two signals together, as `timeout` and some terminals send them, are one wish ----
"$breccia" run bar.yaml --quiet --output twice > out 2>&1 &
running=$!
wait_for $running [ -s twice/end.csv ]
kill -TERM $running; sleep 0.02; kill -TERM $running 2> /dev/null
wait $running; equal "two signals: status" $? 130
[ -e twice/checkpoint.h5 ] || fail "two signals: no checkpoint: $(cat out)"
checks=$((checks + 1))

# ---- files beyond the size that is allowed: a write that fails, the first one or the last ----
"$breccia" run bar.yaml --quiet --output small --steps 300 > out 2>&1 || fail "small: $(cat out)"
for size in 8 $(($(stat -c %s small/results.vtkhdf) / 1024 - 1)); do # kB
  rm -rf large
  (ulimit -S -f $size && exec "$breccia" run bar.yaml --quiet --output large --steps 300) > out 2>&1
  equal "files of $size kB: status" $? 1
  equal "files of $size kB: $(cat out): lines" "$(wc -l < out)" 1
  contains "files of $size kB" "$(cat out)" "large/results.vtkhdf: cannot be written: File too large"
  [ -z "$(find large -name '*.part')" ] || fail "files of $size kB: left behind: $(find large -name '*.part')"
  again=
  [ -e large/checkpoint.h5 ] && again=--restart
  "$breccia" run bar.yaml --quiet --output large --steps 300 $again > out 2>&1 || fail "files of $size kB: $(cat out)"
  for file in checkpoint.h5 results.vtkhdf; do
    "$build/tests/compare_results" small/$file large/$file > out || fail "files of $size kB: $file differs: $(cat out)"
    checks=$((checks + 1))
  done
done

# ---- memory that is allowed: OpenBLAS would ask without an end for what it works in, and is not asked where it is not to be had ----
equations() { timeout 120 "$breccia" "$@" bar.yaml --set 'body.b.shape.box.particles=[12, 5]' --set 'loads.1.displacement=[0, 0]' --set 'solve={static: {increments: 1, equations: direct}}' --output "limited-$1"; }
if [ -z "${BRECCIA_SANITIZED:-}" ] && ldd "$breccia" | grep -q openblas; then # the sanitizers take more than is allowed here
  for verb in run modes; do
    told=0
    for most in $(seq 100000 10000 260000); do # kB; with less loader and HDF5 lack the room for themselves
      (ulimit -S -v "$most" && OMP_NUM_THREADS=1 equations $verb) > out 2> errors
      status=$?
      [ $status = 127 ] && continue
      if [ $status = 0 ]; then break; fi
      equal "$verb with $most kB: $(cat errors): status" $status 1
      equal "$verb with $most kB: $(cat errors): lines" "$(wc -l < errors)" 1
      contains "$verb with $most kB" "$(cat errors)" "out of memory"
      grep -q OpenBLAS errors && told=1
    done
    equal "$verb: status where there is room" $status 0
    equal "$verb: OpenBLAS lacked memory" $told 1
  done
fi

# ---- energy from nothing: it must last for three steps; the one to go on from is that before the first of them ----
sed 's/time step: 2e-5/time step: 4e-4/; s/checkpoint steps: 20000/checkpoint steps: 1/; s/100000000/400/' bar.yaml > wild.yaml
"$breccia" run wild.yaml --quiet --force --output wild > out 2>&1; equal "energy from nothing: status" $? 1
contains "energy from nothing" "$(cat out)" "energy from nothing"
"$breccia" run wild.yaml --force --output wild --restart > out 2>&1; equal "energy from nothing, again: status" $? 1
steps=$(sed -n 's/^stopped by a failure at step .* s for \([0-9]*\) steps.*/\1/p' out)
[ "${steps:-0}" -ge 2 ] || fail "energy from nothing: taken up only ${steps:-?} steps before the run was stopped: $(cat out)"
checks=$((checks + 1))
finish

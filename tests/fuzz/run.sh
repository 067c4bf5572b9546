#!/bin/sh
# Runs the four fuzz targets, two at a time: fuzz_deck from the decks of the examples, fuzz_model from small ones, fuzz_server and
# fuzz_client from conversations. Each runs for the seconds given or, if FUZZ_RUNS is set, that number of inputs; FUZZ_ONLY names one target.
set -eu
cd "$(dirname "$0")/../.."
limit=${FUZZ_RUNS:+-runs=$FUZZ_RUNS}
limit=${limit:--max_total_time=$1}
programs=build/asan-ubsan
mkdir -p build/fuzz
# libfyaml loses what it grows for a text of more than 64 parts, as \\n is between double quotation marks. Only here: elsewhere what we lose of a deck is to be seen.
{ cat tests/leaks.txt && echo leak:libfyaml; } > build/fuzz/leaks.txt
fuzz() { # fuzz TARGET LONGEST FOLDER [options]: inputs of so many bytes at most, from those in the folder
  target=$1 longest=$2 folder=$3
  shift 3
  [ "${FUZZ_ONLY:-$target}" = "$target" ] || return 0
  LSAN_OPTIONS="suppressions=build/fuzz/leaks.txt:print_suppressions=0" "$programs/$target" "$limit" \
    -seed="${FUZZ_SEED:-0}" -max_len="$longest" -rss_limit_mb=2048 -timeout=20 -artifact_prefix=build/fuzz/ \
    -verbosity=0 -print_final_stats=1 "$@" "$folder" > "build/fuzz/$target.txt" 2>&1 &
  running="$running $target:$!"
}
running=""
finish() { # waits for the targets that run, prints what each wrote, and fails if one failed
  failed=""
  for one in $running; do
    wait "${one#*:}" || failed="$failed ${one%:*}"
    cat "build/fuzz/${one%:*}.txt"
  done
  running=""
  [ -z "$failed" ] || { echo "failed:$failed" >&2; exit 1; }
}

# A deck of each law of the laboratory's examples, and those of bodies of all kinds.
mkdir -p build/fuzz/models
cp tests/fuzz/decks/*.yaml build/fuzz/models
for deck in examples/materials/*.yaml; do
  law=$(basename "$deck" .yaml)
  case $law in
  *-softening | elastic-1d | elastic-brittle | elastic-perfectly-plastic) with=bond-based ;;
  kent* | concrete02 | mander | steel* | menegotto*) with=bond-based ;;
  *) with=correspondence ;;
  esac
  {
    echo 'units: {length: m, force: kN, time: s}'
    printf 'materials:\n  m:\n'
    sed -n '/^material:/,/^[a-ln-z]/s/^  [^ ]/  &/p' "$deck"
    echo 'body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}'
    echo "peridynamics: {formulation: $with}"
    echo 'loads:'
    echo '  - {on: {face: x-, layers: 2}, displacement: [0, 0, 0]}'
    echo '  - {on: {face: x+, layers: 2}, velocity: [-50, 10, free]}'
    echo 'solve: {explicit: {steps: 5}}'
  } > "build/fuzz/models/law-$law.yaml"
done
fuzz fuzz_model 4096 build/fuzz/models -dict=tests/fuzz/deck.dict

mkdir -p build/fuzz/corpus
printf "title: '%s'\n" "$(printf "%070d" 0 | sed "s/0/''/g")" > build/fuzz/corpus/quotes.yaml
for deck in examples/*/*.yaml; do
  cp "$deck" "build/fuzz/corpus/$(basename "$(dirname "$deck")")-$(basename "$deck")"
done
cat > build/fuzz/corpus/reuse.yaml << 'Y'
--set body.block.spacing=${2*dx}
variables: {width: 0.2 m, n: 4, dx: "${width/n}", E: 30 GPa, c: "${sqrt(E/(2400 kg/m3))}"}
materials:
  rock: &rock {model: elastic, density: 2400 kg/m3, Young modulus: "${E}", Poisson ratio: 0.2}
  sand: {<<: *rock, density: 2}
body:
  block:
    {material: rock, spacing: '${dx}', shape: {box: {from: [0, 0, 0], to: ["${2*width}", "${max(dx, 10 cm)}", 1]}}}
loads: [{name: pull, on: {face: x+}, velocity: ["${sin(30 deg)*c}", free, free]}]
solve: {explicit: {end time: "${(1 + 2)^2 * 1 ms - abs(-1 us)}"}}
Y
fuzz fuzz_deck 4096 build/fuzz/corpus -dict=tests/fuzz/deck.dict
finish

mkdir -p build/fuzz/frames
# A conversation: CREATE of two points, a trial, a commit with a trial, save.
{ printf '\1\3\0\2\106\1command: j2; Young modulus=2e8; Poisson ratio=0.3; yield stress=4e5\n\n'
  printf '\5\0\1\70\1\0\0\0\0\0\0\0\0%48s' ''
  printf '\6\0\0\0\1\10\0\1\10\1\0\0\0\0\0\0\0\0'; } > build/fuzz/frames/j2
printf '\4BRMS\1\0\205\0\1\0\0\0\0\0\0\0\1\0\0\0' > build/fuzz/frames/client
printf '\2BRMS\1\0\1\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\10' > build/fuzz/frames/greeting
# The server frees in a thread of its own, often after an input has ended: leaks are looked for once, when all is over.
fuzz fuzz_server 1024 build/fuzz/frames -detect_leaks=0

mkdir -p build/fuzz/answers
# Good answers to HELLO, PROBE, CREATE and what follows; and a law of one strain told by hand.
{ for n in $(seq 12); do printf '\1\0\0\0'; done; } > build/fuzz/answers/good
{ printf '\1\0\0\0\0\0\0\60components: 1\nbulk: 2e5\nshear: 1e5\nfailure: 0.1\n'
  printf '\1\0\0\0\0\0\0\30%24s' ''; } > build/fuzz/answers/uniaxial
printf '\1\0\0\0\1\0\0\0\1\0\0\0\0\100\0\0' > build/fuzz/answers/refusal-without-words
fuzz fuzz_client 512 build/fuzz/answers
finish

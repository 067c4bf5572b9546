# Pages made from the program's tables are current, and the schema is JSON that the decks of the examples obey.
. "$(dirname "$0")/common.sh"
"$breccia" schema --markdown > "$work/deck.md"
cmp -s "$work/deck.md" "$source/docs/deck.md" || fail "docs/deck.md is not current: run 'make docs'"
"$breccia" models --markdown > "$work/models.md"
cmp -s "$work/models.md" "$source/docs/models.md" || fail "docs/models.md is not current: run 'make docs'"
sh "$source/scripts/command_page.sh" "$breccia" > "$work/command.md"
cmp -s "$work/command.md" "$source/docs/command.md" || fail "docs/command.md is not current: run 'make docs'"
if command -v python3 > /dev/null; then
  python3 "$source/scripts/drawings.py" "$work/pictures"
  diff -r "$work/pictures" "$source/docs/pictures" > /dev/null || fail "docs/pictures is not current: run 'make docs'"
fi
every=8 # one in so many laws and decks; test_example_decks makes models of all decks
[ -z "${BRECCIA_WHOLE:-}" ] || every=1
[ -z "${BRECCIA_SANITIZED:-}" ] || every=17
number=0
for name in $("$breccia" models | sed -n '/^Formulations/q; s/^\([a-z0-9-]*\): .*/\1/p'); do
  [ -s "$source/docs/models/$name.png" ] || fail "docs/models/$name.png is missing: run 'make docs'"
  [ $((number++ % every)) = 0 ] || continue
  "$breccia" material "$source/examples/materials/$name.yaml" > "$work/curve.csv" || fail "examples/materials/$name.yaml does not run"
  checks=$((checks + 1))
done
"$breccia" schema > "$work/schema.json"
contains "schema" "$(cat "$work/schema.json")" '"$schema": "https://json-schema.org/draft/2020-12/schema"'
if command -v python3 > /dev/null; then
  python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/schema.json" || fail "the schema is not JSON"
fi
# It asks for the same keys of each section as the page does. Those of a material depend on its law.
if command -v python3 > /dev/null; then
  python3 - "$work/schema.json" "$work/deck.md" << 'END' || fail "the schema and docs/deck.md differ in what must be given"
import json, re, sys
sections, groups, required, name = json.load(open(sys.argv[1]))["$defs"], {}, {}, None
for line in open(sys.argv[2]):
    cells = line.split("|")
    found = re.match(r"Exactly one of these \(.\): (.*)\.$", line)
    if line.startswith("## "):
        name = line[3:].strip()
    elif found:
        groups.setdefault(name, set()).update(re.findall("`([^`]*)`", found[1]))
    elif len(cells) > 4 and cells[3].strip() == "**required**":
        required.setdefault(name, set()).add(cells[1].strip(" `"))
bad = len(groups) < 10 or len(required) < 10
for name, section in sections.items():
    chosen = {key for one in section.get("oneOf", []) for key in one["required"]}
    if name != "material" and (chosen != groups.get(name, set()) or set(section["required"]) != required.get(name, set())):
        print(f"{name}: one of {sorted(chosen)}, and {sorted(section['required'])}")
        bad = True
sys.exit(bad)
END
  checks=$((checks + 1))
fi

# Each example is in the command, as its folder has it, and is taken with nothing around it but what `new` writes.
mkdir "$work/examples"
listed=$("$breccia" new --example)
for deck in "$source"/examples/*/*.yaml; do
  [ $((number++ % every)) = 0 ] || continue
  name=${deck#"$source/examples/"} name=${name%.yaml}
  folder=$work/examples/$name deck=$work/examples/$name/taken.yaml
  mkdir -p "$folder"
  "$breccia" new --example "$name" "$deck" > "$work/out" 2>&1 || { fail "new --example $name: $(cat "$work/out")"; continue; }
  cmp -s "$deck" "$source/examples/$name.yaml" || fail "new --example $name writes another deck than examples/$name.yaml"
  contains "list of examples" "$listed" "  $name "
  if ! grep -q '^body:' "$deck"; then
    "$breccia" material "$deck" > "$work/out" 2>&1 || fail "$name is refused: $(tail -3 "$work/out")"
    continue
  fi
  # Its law needs OpenSees, which `make test-external` sets up; here the rest of the deck is read with a server of our own.
  if grep -q ' opensees: ' "$deck"; then
    rm -f "$work/socket"
    "$breccia" serve --listen "unix:$work/socket" --once > /dev/null &
    wait_for $! [ -S "$work/socket" ] || fail "the server of $name does not begin"
    sed -i "s|    opensees: .*|    remote: elastic; Young modulus=1e5; Poisson ratio=0.25\n    server: ['unix:$work/socket']|" "$deck"
  fi
  "$breccia" check "$deck" > "$work/out" 2>&1 || fail "$name is refused: $(cat "$work/out")"
  checks=$((checks + 1))
done

# The deck that a deck includes, and CSV files and records that both name, go into the command with it, to the last byte.
mkdir -p "$work/tree/examples/dam"
printf 'x,y,z,volume\n0,0,0,"1"\n\\' > "$work/tree/examples/dam/points.csv"
printf 'NPTS= 1, DT= .01 SEC\n0' > "$work/tree/examples/dam/shake.AT2"
printf 'body: {dam: {file: points.csv}} # other.csv is not there\n' > "$work/tree/examples/dam/dam.yaml"
printf 'include: dam.yaml # and shake.AT2, not other.yaml\n' > "$work/tree/examples/dam/rock.yaml"
cat > "$work/print.c" << 'END'
#include "examples.h"
#include <stdio.h>
int main(void)
{
  for (const ExampleFile *f = examples[0].files; f->name; ++f) {
    printf("%s/%s:", examples[0].name, f->name);
    fwrite(f->bytes, 1, f->length, stdout);
  }
  return examples[1].name != NULL;
}
END
cmake "-DSOURCE=$work/tree" -DDECKS=examples/dam/rock.yaml "-DOUTPUT=$work/embedded.c" -P "$source/scripts/embed_examples.cmake" &&
  cc "-I$source/source/cli" -o "$work/print" "$work/print.c" "$work/embedded.c" || fail "an example with a CSV file cannot be embedded"
equal "embedded example" "$("$work/print")" "dam/rock/rock.yaml:$(cat "$work/tree/examples/dam/rock.yaml")
dam/rock/dam.yaml:$(cat "$work/tree/examples/dam/dam.yaml")
dam/rock/shake.AT2:$(cat "$work/tree/examples/dam/shake.AT2")dam/rock/points.csv:$(cat "$work/tree/examples/dam/points.csv")"

# The decks that pages show whole are decks.
awk '/^```yaml$/{on = 1; text = ""; next} /^```$/{if (on && text ~ /(^|\n)body:/) print text > sprintf("%s-%d.yaml", out, ++n); on = 0} on{text = text $0 "\n"}' \
  out="$work/shown" "$source/README.md" "$source/docs/deck.md" "$source/docs/choosing.md" "$source/docs/guide.md"
for deck in "$work"/shown-*.yaml; do
  [ $((number++ % every)) = 0 ] || continue
  "$breccia" check "$deck" > "$work/out" 2>&1 || fail "a deck shown by README.md, docs/deck.md, docs/choosing.md or docs/guide.md is refused: $(cat "$work/out")"
  checks=$((checks + 1))
done

# Ground at rest has K0 of its law and the stress of its weight, and its displacements count from there.
"$breccia" run "$(grep -l '^title: Ground at rest' "$work"/shown-*.yaml)" --output "$work/ground" > "$work/out" 2>&1 || fail "ground at rest: $(cat "$work/out")"
awk -F, 'function near(a, b, t) {if (a - b > t || b - a > t) bad = 1} NR == 3 {near($9 / $10, 3 / 7, 1e-6); near($10, -1.9 * 9.81 * 3.125, 0.5)}
  NR == 4 {near($9 / $10, 3 / 7, 1e-6)} END {exit bad || NR != 4}' "$work/ground/deep.csv" || fail "ground at rest: $(cat "$work/ground/deep.csv")"
awk -F, 'NR == 3 && $4 > -1e-3 {bad = 1} NR == 4 && ($4 > 1e-9 || $4 < -1e-9) {bad = 1} END {exit bad || NR != 4}' "$work/ground/moved.csv" || fail "ground at rest: $(cat "$work/ground/moved.csv")"
# The same with a K0 of its own: stresses of the weight from the start, and next to no displacement.
"$breccia" run "$(grep -l '^title: Ground with K0' "$work"/shown-*.yaml)" --output "$work/ground" > "$work/out" 2>&1 || fail "ground with K0: $(cat "$work/out")"
awk -F, 'function near(a, b, t) {if (a - b > t || b - a > t) bad = 1} NR > 1 {near($9 / $10, 0.5, 1e-4); near($11 / $10, 0.5, 1e-4); near($10, -1.9 * 9.81 * 3.125, 0.01)}
  END {exit bad || NR != 4}' "$work/ground/deep.csv" || fail "ground with K0: $(cat "$work/ground/deep.csv")"
awk -F, 'NR == 3 && ($4 > 1e-5 || $4 < -1e-5) {bad = 1} END {exit bad || NR != 4}' "$work/ground/moved.csv" || fail "ground with K0: $(cat "$work/ground/moved.csv")"
checks=$((checks + 5))

# The run of the vertical cut has status 0 and a factor of safety that is above 3.776 s_u / (gamma H) = 1.604 by no more
# than the excess that its last words tell, and below by 5 % at most. Round-off in increments without equilibrium decides on 2 % of the factor.
"$breccia" run "$(grep -l '^title: A vertical cut' "$work"/shown-*.yaml)" --set 'variables.spacing=1 m' --output "$work/cut" > "$work/out" 2>&1 || fail "the cut: $(cat "$work/out")"
sed -n 's/^factor of safety \([0-9.]*\): .* divided by \([0-9.]*\) they .*$/\1 \2/p; s/.* may be some \([0-9]*\) % too high$/\1/p' "$work/out" |
  awk 'NR == 1 {f = $1; lost = $2} END {exit !(NR == 2 && f > 0.95 * 1.604 && lost > f && lost < f + 0.01 && f / 1.604 < 1 + ($1 + 4) / 100)}' || fail "the factor of the cut: $(cat "$work/out")"
grep -q 'the peak may lie' "$work/out" && fail "a peak of the force of a support while strengths are reduced: $(cat "$work/out")"
checks=$((checks + 3))

# The guide's beam is as stiff as Timoshenko's (50.97 kN/mm), its plates share the load of the jack, and it carries what the page says.
"$breccia" run "$(grep -l '^title: Simply supported beam' "$work"/shown-*.yaml)" --output "$work/beam" > "$work/out" 2>&1 || fail "the guide's beam: $(cat "$work/out")"
awk -F, 'NR == 3 {first = -$4 / ($2 * 1)} -$4 > most {most = -$4} END {exit !(first > 0.98 * 50.97 && first < 1.02 * 50.97 && most > 7.5 && most < 7.72)}' "$work/beam/jack.csv" ||
  fail "the guide's beam: $(cat "$work/beam/jack.csv")"
sed -n "s/^  load '\(left\|right\|jack\)': \[0, -*\([0-9.]*\), 0\] kN.*, only presses\$/\2/p" "$work/out" |
  awk '{f[NR] = $1} END {exit !(NR == 3 && f[1] == f[2] && f[1] + f[2] > 0.999 * f[3] && f[1] + f[2] < 1.001 * f[3])}' || fail "the plates of the guide's beam: $(cat "$work/out")"
checks=$((checks + 3))

sed -n '/^```yaml$/,/^```$/p' "$source/README.md" | sed '/^```/d' | cmp -s - "$source/examples/notched-beam/beam.yaml" ||
  fail "the deck that README.md shows is not examples/notched-beam/beam.yaml"

# Behaviour depends on capabilities of formulations and solvers, and on roles of parameters (source/constitutive/
# parameter_roles.h), and not on their names: beyond the deck reader and the command no name is compared with a word.
"$breccia" models | awk '/^[a-z0-9-]+: / {sub(/:.*/, ""); print} /^  [A-Za-z]/ && substr($0, 28, 1) ~ /[a-z1-]/ {name = substr($0, 3, 24); sub(/ +$/, "", name); print name}' |
  grep -vx length > "$work/names" # also a dimension
printf '%s\n' explicit static implicit relaxation 'minimal residuals' 'conjugate gradients' direct >> "$work/names"
[ "$(grep -xE 'hybrid|mazars|fracture energy|Young modulus|compressive yield stress' "$work/names" | sort -u | wc -l)" = 5 ] ||
  fail "names of formulations, laws and parameters: $(tr '\n' ',' < "$work/names")"
find "$source/source" -name '*.[ch]' ! -path '*/deck/*' ! -path '*/cli/*' -exec cat {} + | tr '\n' ' ' |
  grep -oE 'strn?cmp\(([^()]|\([^()]*\))*\)' | grep -oE '"[^"]*"' | tr -d '"' | sort -u | grep -xF -f "$work/names" > "$work/compared" &&
  fail "a name is compared with a word in source/: $(tr '\n' ',' < "$work/compared")"
checks=$((checks + 2))

# The factors of bending strength that `check` tells are those of the measured table.
sed -n 's/^    {"\([a-z-]*\)", "\([a-z-]*\)", \([0-9]*\), {\([0-9.]*\), \([0-9.]*\), \([0-9.]*\)}},$/\1 \2 \3 \4 \5 \6/p' \
  "$source/source/domain/bending_strength.c" > "$work/told"
sed -n '/^<!-- bending strength -->$/,/^<!-- end of bending strength -->$/p' "$source/docs/choosing.md" |
  awk -F' *[|] *' '$2 ~ /^[a-z]/ && $6 ~ /^[0-9]/ {split($7, a, "[ ()]+"); split($8, b, "[ ()]+"); split($9, c, "[ ()]+"); print $2, $3, $6, a[1], b[1], c[1]; print $2, $3, 0, a[2], b[2], c[2]}' | sort -u > "$work/shown"
[ -s "$work/shown" ] && sort "$work/told" | diff "$work/shown" - || fail "source/domain/bending_strength.c has other factors than the table of docs/choosing.md"
checks=$((checks + 1))

# What `check` is shown to tell is what it tells, the expected time of another machine aside.
"$breccia" check "$source/examples/notched-beam/beam.yaml" | sed 's/, about [0-9.]* [a-z]*$//' > "$work/told"
sed -n '/^## What `check` tells/,/^## /p' "$source/docs/choosing.md" | sed -n '/^```$/,/^```$/p' | sed '/^```$/d; s/, about [0-9.]* [a-z]*$//' > "$work/shown"
[ -s "$work/shown" ] && diff "$work/shown" "$work/told" || fail "docs/choosing.md shows another 'breccia check' of the notched beam than the program tells"
checks=$((checks + 1))

# The decks that newcomers run first lose no energy, and one that is damped says that it has come to rest.
"$breccia" new "$work/starter.yaml" > /dev/null
cp "$source/examples/bar/bar.yaml" "$work/bar.yaml"
sed 's/end time: 12 ms/end time: 12 ms, damping: {ratio: 1, at: 880 Hz}/' "$work/bar.yaml" > "$work/damped.yaml"
for deck in starter bar damped; do
  "$breccia" run "$work/$deck.yaml" > "$work/out" 2>&1 || fail "$deck.yaml: $(cat "$work/out")"
  json "$work/$deck/summary.json" imbalance | awk '{exit !(NR == 1 && $1 >= 0 && $1 < 0.005)}' || fail "$deck.yaml: $(grep '^energy' "$work/out")"
  checks=$((checks + 1))
done
contains "a damped bar" "$(cat "$work/out")" "
at rest: forces out of balance are"

# The guide's pieces, the first of each section, are one deck.
awk '/^    [a-z]+:/{key = $1; on = !(key in seen) && key ~ /^(units|materials|body|cracks|peridynamics|failure|loads|solve|watch|results|pictures):$/; seen[key] = 1}
  /^ ? ? ?[^ ]/{on = 0} on{print substr($0, 5)}' "$source/docs/guide.md" > "$work/guide.yaml"
"$breccia" check "$work/guide.yaml" > "$work/out" 2>&1 || fail "the deck of docs/guide.md is refused: $(cat "$work/out")"
equal "sections of the guide's deck" "$(grep -c '^[a-z]*:' "$work/guide.yaml")" 11

# What a page links to is there.
cd "$source" || exit 1

# Scripts put tables between marks, of which a page has one of each name.
for page in docs/*.md examples/*/README.md; do
  twice=$(grep -o '^<!-- .* -->$' "$page" | sort | uniq -d)
  [ -z "$twice" ] || fail "$page has these marks twice: $twice"
  checks=$((checks + 1))
done
for page in README.md docs/*.md examples/*/README.md; do
  for target in $(grep -oE '\]\([^)#]+' "$page" | sed 's/^](//' | grep '[.]' | grep -v '^https:'); do
    [ -e "$(dirname "$page")/$target" ] || fail "$page links to $target, which is not there"
    checks=$((checks + 1))
  done
done

# Plain words: a reader with a dictionary of technical English must not stumble over pictures of speech.
figures='\balive\b|\blen(d|ds|t)\b|\bat home\b|\bof chance\b|\b(law|laws|points) elsewhere\b|\blives? (in|on)\b|\bhangs? on\b|\banew\b|\bto and fro\b'
pages="README.md CHANGELOG.md Makefile CMakeLists.txt docs examples source include bench servers scripts tests/command tests/unit tests/external tests/fuzz"
[ -e .ci ] && pages="$pages .ci"
grep -rnIiE "$figures" $pages --include=* --exclude=documents.sh && fail "these lines say in a figure of speech what plain words say better"
grep -rnIiE 'seed (paper|document)' $pages --exclude=documents.sh --exclude=theory.md && fail "only docs/theory.md knows S0, S1 and S2"
grep -nE '\b(house|rooms?)\b' README.md docs/guide.md docs/choosing.md docs/deck.md docs/models.md docs/material-server.md docs/theory.md \
  && fail "house and room are words of docs/design.md"
checks=$((checks + 3))
grep -rnE '/(root|home|work)/' "$source/README.md" "$source/docs" "$source"/examples/*/README.md && fail "a page holds a machine's path"
finish

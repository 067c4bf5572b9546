#!/bin/sh
# The pages that the program makes itself, and the pictures of its models.
set -eu
breccia=build/release/breccia
[ -x $breccia ] || { echo "$breccia is not there, and pages would be emptied: use 'make docs', which builds it" >&2; exit 1; }
$breccia schema --markdown > docs/deck.md
$breccia models --markdown > docs/models.md
sh scripts/command_page.sh $breccia > docs/command.md
python3 scripts/drawings.py docs/pictures
mkdir -p docs/models
for file in examples/materials/*.yaml; do
  name=$(basename "$file" .yaml)
  $breccia material "$file" --picture "docs/models/$name.png" --output /dev/null > /dev/null
done
made=$(mktemp -d)
mkdir -p docs/lattices
for name in plane space; do
  $breccia run "scripts/lattices-$name.yaml" --output "$made/$name" > /dev/null
  cp "$made/$name/pictures/$name.png" docs/lattices/
done
mkdir -p docs/bars
$breccia run scripts/bars.yaml --output "$made/bars" > /dev/null
cp "$made"/bars/pictures/*.png docs/bars/
mkdir -p docs/beam
awk '/^```yaml$/{on = 1; next} /^```$/{on = whole = 0} on && /^title: Simply supported beam/{whole = 1} whole' docs/guide.md > "$made/beam.yaml"
$breccia run "$made/beam.yaml" --output "$made/beam" > /dev/null
cp "$made"/beam/pictures/*.png docs/beam/
rm -r "$made"

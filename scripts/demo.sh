#!/bin/sh
# Runs the first example whole and ends with what happened and where the pictures are.
set -eu
cd "$(dirname "$0")/../examples/plate-with-crack"
for deck in clay elastic; do
  ../../build/release/breccia run $deck.yaml
  echo
done
../../build/release/breccia plot clay elastic --curve "mouth.distance : pull.value" \
  --title "Crack opening at the mouth against load" --output opening-against-load.png > /dev/null
rm -f clay/opening-against-load.png
mv opening-against-load.png clay/pictures/
echo "Look at examples/plate-with-crack/clay/pictures and examples/plate-with-crack/elastic/pictures."

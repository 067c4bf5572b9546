#!/bin/sh
# fuzz_deck from the decks of the examples, for so many seconds.
set -eu
cd "$(dirname "$0")/../.."
mkdir -p build/fuzz/corpus
for deck in examples/*/*.yaml; do
  cp "$deck" "build/fuzz/corpus/$(basename "$(dirname "$deck")")-$(basename "$deck")"
done
LSAN_OPTIONS="suppressions=tests/leaks.txt:print_suppressions=0" build/fuzz/fuzz_deck -max_total_time="$1" -seed="${FUZZ_SEED:-0}" -max_len=4096 -rss_limit_mb=2048 -timeout=20 -artifact_prefix=build/fuzz/ \
  -dict=tests/fuzz/deck.dict -verbosity=0 -print_final_stats=1 build/fuzz/corpus

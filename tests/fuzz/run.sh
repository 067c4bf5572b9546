#!/bin/sh
# fuzz_deck from the decks of the examples, then fuzz_server from conversations, for so many seconds each.
set -eu
cd "$(dirname "$0")/../.."
mkdir -p build/fuzz/corpus
for deck in examples/*/*.yaml; do
  cp "$deck" "build/fuzz/corpus/$(basename "$(dirname "$deck")")-$(basename "$deck")"
done
LSAN_OPTIONS="suppressions=tests/leaks.txt:print_suppressions=0" build/fuzz/fuzz_deck -max_total_time="$1" -seed="${FUZZ_SEED:-0}" -max_len=4096 -rss_limit_mb=2048 -timeout=20 -artifact_prefix=build/fuzz/ \
  -dict=tests/fuzz/deck.dict -verbosity=0 -print_final_stats=1 build/fuzz/corpus

mkdir -p build/fuzz/frames
# A conversation: CREATE of two points, a trial, a commit with a trial, save.
{ printf '\1\3\0\2\106\1command: j2; Young modulus=2e8; Poisson ratio=0.3; yield stress=4e5\n\n'
  printf '\5\0\1\70\1\0\0\0\0\0\0\0\0%48s' ''
  printf '\6\0\0\0\1\10\0\1\10\1\0\0\0\0\0\0\0\0'; } > build/fuzz/frames/j2
printf '\4BRMS\1\0\205\0\1\0\0\0\0\0\0\0\1\0\0\0' > build/fuzz/frames/client
LSAN_OPTIONS="suppressions=tests/leaks.txt:print_suppressions=0" build/fuzz/fuzz_server -max_total_time="$1" -seed="${FUZZ_SEED:-0}" -max_len=1024 -rss_limit_mb=2048 -timeout=20 -artifact_prefix=build/fuzz/ \
  -verbosity=0 -print_final_stats=1 build/fuzz/frames

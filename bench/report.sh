#!/bin/bash
# Runs the bench and the comparison with LAMMPS and writes their tables into docs/performance.md (about seven minutes).
set -eu
cd "$(dirname "$0")/.."
build/release/breccia_bench build/release/bench.csv > build/release/bench.md
build/release/breccia_peers > build/release/peers.md
build/release/breccia_bench_laws > build/release/laws.md
page=docs/performance.md
{
  sed '/^<!-- bench -->$/q' $page
  echo
  cat build/release/bench.md
  echo
  cat build/release/peers.md
  echo
  cat build/release/laws.md
  echo
  sed -n '/^<!-- end of bench -->$/,$p' $page
} > build/release/page.md
cp build/release/page.md $page

#!/bin/bash
# Runs the plate by all models, and writes the table and pictures of README.md: a minute and a half of a processor.
#   report.sh                run everything, then write
#   report.sh --only-write   write from the results that are there
cd "$(dirname "$0")" && mkdir -p pictures && PYTHONPATH=.. exec python3 -B report.py "$@"

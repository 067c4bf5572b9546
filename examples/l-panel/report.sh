#!/bin/bash
# Runs the panel by all models, and writes the tables and pictures of README.md: about two minutes of a processor.
#   report.sh                run everything, then write
#   report.sh --only-write   write from the results that are there
cd "$(dirname "$0")" && mkdir -p pictures && PYTHONPATH=.. exec python3 -B report.py "$@"

#!/bin/bash
# Makes README.md's table and pictures.
cd "$(dirname "$0")" && PYTHONPATH=.. exec python3 -B report.py "$@"

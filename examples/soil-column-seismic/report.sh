#!/bin/bash
# Writes motions, tables and pictures of README.md from runs of the deck, of a beam in shear, and of finite elements where scripts/opensees.sh has set up OpenSees.
cd "$(dirname "$0")" && python3 -B motions.py && PYTHONPATH=.. exec python3 -B report.py

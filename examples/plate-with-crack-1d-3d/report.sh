#!/bin/bash
# Writes tables and pictures of README.md from runs of the decks, and of finite elements where scripts/opensees.sh has set up OpenSees.
cd "$(dirname "$0")" && PYTHONPATH=.. exec python3 -B report.py

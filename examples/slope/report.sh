#!/bin/bash
# Writes tables and pictures of README.md from runs of the deck.
cd "$(dirname "$0")" && PYTHONPATH=.. exec python3 -B report.py

#!/bin/bash
# Finds the failure load of README.md's table, and draws its pictures.
cd "$(dirname "$0")" && PYTHONPATH=.. exec python3 -B report.py

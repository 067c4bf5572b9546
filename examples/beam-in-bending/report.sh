#!/bin/bash
# Makes README.md's tables and pictures.
cd "$(dirname "$0")" && PYTHONPATH=.. exec python3 -B report.py

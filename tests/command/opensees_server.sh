#!/bin/bash
# The Python server of OpenSees over a stand-in for OpenSees: clients, commits, sockets.
. "$(dirname "$0")/common.sh"
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source/tests/command/stand_in python3 "$source/tests/command/opensees_server.py" "$source/servers/opensees_server.py" "$work"

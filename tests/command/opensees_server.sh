#!/bin/bash
# The servers of OpenSees over stand-ins for OpenSees: clients, commits, sockets. The Tcl one where there is a tclsh.
. "$(dirname "$0")/common.sh"
try() { python3 "$source/tests/command/opensees_server.py" "$work" "$@" || fail "$1"; }
export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source/tests/command/stand_in
try python3 "$source/servers/opensees_server.py"
if command -v tclsh > /dev/null; then
  try tclsh "$source/tests/command/stand_in/opensees.tcl" "$source/servers/opensees_server.tcl"
else
  echo "no tclsh: the Tcl server is not tried"
fi
[ $failures = 0 ]

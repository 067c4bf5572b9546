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

# The page of what OpenSees offers: every command with what is made of it below, and the kinds, in lines of a page's width.
cat > "$work/page.py" << 'P'
import runpy
import sys

server = runpy.run_path(sys.argv[1])
there = server["main"].__globals__
there["TRIED"] = [("nDMaterial Bars $tag 2e8", "kPa", None), ("nDMaterial Cloth $tag 3 1.5", "Pa", None)]
there["known_kinds"] = lambda ops, words, command: [f"{command[0]}Kind{k:02}" for k in range(15)]
sys.argv = sys.argv[1:]
server["main"]()
P
printf '#!/bin/sh\nexec python3 "%s/page.py" "%s/servers/opensees_server.py" "$@"\n' "$work" "$source" > "$work/offers"
chmod +x "$work/offers"
BRECCIA_OPENSEES=$work/offers "$breccia" models --opensees > "$work/page" 2>&1
cat > "$work/wanted" << 'P'
OpenSees stand-in. Commands to begin with, and what it makes of them:

  nDMaterial Bars $tag 2e8
      stress unit: kPa; moduli: bulk 6.667e+07 kPa, shear 2e+08 kPa
  nDMaterial Cloth $tag 3 1.5
      stress unit: Pa; OpenSees refuses 'Cloth': Cloth is unknown

Kinds of nDMaterial; a run tells whether one takes strain in space:

  nKind00 nKind01 nKind02 nKind03 nKind04 nKind05 nKind06 nKind07 nKind08 nKind09 nKind10 nKind11
  nKind12 nKind13 nKind14

Kinds of uniaxialMaterial, for laws per bond:

  uKind00 uKind01 uKind02 uKind03 uKind04 uKind05 uKind06 uKind07 uKind08 uKind09 uKind10 uKind11
  uKind12 uKind13 uKind14
P
diff "$work/wanted" "$work/page" || fail "the page of OpenSees is another one"
[ $failures = 0 ]

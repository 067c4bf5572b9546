#!/bin/sh
# Sets up an unmodified OpenSees from its Python package, in an environment of the project's own, as a material server beside the
# program: build/release/breccia-opensees. Does nothing when it is there.
set -eu
cd "$(dirname "$0")/.."
environment=.venv/opensees
if ! cmp -s servers/requirements.txt "$environment/installed" 2> /dev/null; then
  sh scripts/setup.sh opensees
  python3 -m venv --clear "$environment"
  "$environment/bin/python" -m pip install --quiet --disable-pip-version-check -r servers/requirements.txt
  cp servers/requirements.txt "$environment/installed"
fi
mkdir -p build/release
cat > build/release/breccia-opensees << END
#!/bin/sh
exec "$PWD/$environment/bin/python" "$PWD/servers/opensees_server.py" "\$@"
END
chmod +x build/release/breccia-opensees

# Pages made from the program's tables are current, and the schema is JSON that the decks of the examples obey.
. "$(dirname "$0")/common.sh"
"$breccia" schema --markdown > "$work/deck.md"
cmp -s "$work/deck.md" "$source/docs/deck.md" || fail "docs/deck.md is not current: run 'make docs'"
"$breccia" models --markdown > "$work/models.md"
cmp -s "$work/models.md" "$source/docs/models.md" || fail "docs/models.md is not current: run 'make docs'"
for name in $("$breccia" models | sed -n '/^Formulations/q; s/^\([a-z0-9-]*\): .*/\1/p'); do
  [ -s "$source/docs/models/$name.png" ] || fail "docs/models/$name.png is missing: run 'make docs'"
  "$breccia" material "$source/examples/materials/$name.yaml" > "$work/curve.csv" || fail "examples/materials/$name.yaml does not run"
  checks=$((checks + 1))
done
"$breccia" schema > "$work/schema.json"
contains "schema" "$(cat "$work/schema.json")" '"$schema": "https://json-schema.org/draft/2020-12/schema"'
if command -v python3 > /dev/null; then
  python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/schema.json" || fail "the schema is not JSON"
fi
for deck in "$source"/examples/*/*.yaml; do
  case "$deck" in */materials/*) continue ;; esac
  # Its law needs OpenSees, which `make test-external` sets up; here the rest of the deck is read with a server of our own.
  if grep -q ' opensees: ' "$deck"; then
    "$breccia" serve --listen "unix:$work/socket" --once > /dev/null &
    for _ in $(seq 100); do [ -S "$work/socket" ] && break; sleep 0.05; done
    sed "s|    opensees: .*|    remote: elastic; Young modulus=1e5; Poisson ratio=0.25\n    server: ['unix:$work/socket']|" "$deck" > "$work/deck.yaml"
    deck=$work/deck.yaml
  fi
  "$breccia" check "$deck" > "$work/out" 2>&1 || fail "$deck is refused: $(cat "$work/out")"
  checks=$((checks + 1))
done
grep -rnE '/(root|home|work)/' "$source/README.md" "$source/docs" "$source"/examples/*/README.md && fail "a page holds a machine's path"
finish

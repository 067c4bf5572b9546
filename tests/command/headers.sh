# Each header compiles alone: it includes what it uses. Lists of table entries (without a guard) and the two widths of vectors are parts of other files.
. "$(dirname "$0")/common.sh"
flags=$(pkg-config --cflags-only-I hdf5-serial cairo 2> /dev/null || pkg-config --cflags-only-I hdf5 cairo) || fail "pkg-config knows neither HDF5 nor Cairo"
cd "$source" || exit 1
for header in $(grep -lr '^#ifndef BRECCIA_' include source --include='*.h' | grep -v '/lanes_\(four\|eight\).h$' | sort); do
  checks=$((checks + 1))
  # shellcheck disable=SC2086
  "${CC:-cc}" -x c -std=c17 -D_POSIX_C_SOURCE=200809L -Iinclude -Isource $flags -Wno-psabi -fsyntax-only -include "$header" /dev/null > "$work/said" 2>&1 ||
    fail "$header does not compile alone: $(grep -m 1 error "$work/said")"
done
[ "$checks" -gt 100 ] || fail "only $checks headers were found"
finish

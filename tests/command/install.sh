# What is installed is enough for another program: header, library, pkg-config file and CMake package; the command runs from there.
. "$(dirname "$0")/common.sh"
cmake --install "$build" --prefix "$work/usr" > "$work/log" 2>&1 || fail "install: $(tail -3 "$work/log")"
"$work/usr/bin/breccia" --version > /dev/null || fail "the installed command does not run"
[ -e "$work/usr/share/man/man1/breccia.1" ] || fail "no manual page"
lib=$(dirname "$(find "$work/usr" -name 'libbreccia.so' | head -1)")
[ -n "$lib" ] || fail "no library"
if [ -z "${BRECCIA_SANITIZED:-}" ]; then
  mkdir "$work/client"
  cp "$source/examples/embedding/embedding.c" "$work/client"
  cat > "$work/client/CMakeLists.txt" <<'C'
cmake_minimum_required(VERSION 3.22)
project(client C)
find_package(breccia REQUIRED)
add_executable(client embedding.c)
target_link_libraries(client breccia::breccia m)
C
  cmake -S "$work/client" -B "$work/client/build" -DCMAKE_PREFIX_PATH="$work/usr" > "$work/log" 2>&1 &&
    cmake --build "$work/client/build" >> "$work/log" 2>&1 || fail "a client does not build: $(tail -5 "$work/log")"
  "$work/client/build/client" > "$work/out" 2>&1 || fail "the client fails: $(cat "$work/out")"
  contains "client" "$(cat "$work/out")" "320 particles after 4000 steps"
  # The prefix has a space in it: pkg-config writes it escaped, eval reads it.
  flags=$(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --cflags --libs breccia) || fail "pkg-config does not find the library"
  eval "cc \"$work/client/embedding.c\" $flags -lm -o \"$work/direct\"" || fail "no client builds with pkg-config"
  LD_LIBRARY_PATH=$lib "$work/direct" > "$work/out" 2>&1 || fail "the client built with pkg-config fails: $(cat "$work/out")"
  contains "client by pkg-config" "$(cat "$work/out")" "320 particles after 4000 steps"
  foreign=$(nm -D --defined-only "$lib/libbreccia.so" | awk '{print $3}' | grep -v '^breccia_' || true)
  equal "names that the library exports beside its own" "$foreign" ""
fi
finish

#!/bin/bash
# Laws in other processes: the same bits as inside the program, over every transport, through restarts; and what is said when servers fail.
. "$(dirname "$0")/common.sh"
cd "$work" || exit 1

deck() { # MATERIAL > a small plate of clay, 60 steps
  cat << END
units: {length: m, force: kN, time: s}
materials:
  clay: {$1, density: 1.5}
body:
  plate: {material: clay, lattice: cubic, spacing: 0.03, shape: {box: {particles: [11, 9, 2], first particle: [0, 0, 0]}}}
peridynamics: {formulation: correspondence, horizon: 3.015 spacings, zero-energy control: {silling: 0.1}}
loads:
  - {on: {face: x-, layers: 3}, body force: [-900, 0, 0], history: {ramp to: 1e-4}}
  - {on: {face: x+, layers: 3}, body force: [900, 0, 0], history: {ramp to: 1e-4}}
solve: {explicit: {time step: 8e-6, steps: 60}}
results: {number: 3, precision: double, checkpoint steps: 20}
pictures: []
END
}
clay='shear modulus: 60000, bulk modulus: 100000, octahedral strength: 30'
served="remote: multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral strength=30"

serve() { # ADDRESS [options]; sets $server
  : > serve.out
  "$breccia" serve --listen "$@" > serve.out 2> serve.err &
  server=$!
  wait_for $server grep -q listening serve.out || fail "serve $1: $(cat serve.err)"
}
stop() { kill "$server" 2> /dev/null; wait "$server" 2> /dev/null; }
same() { "$build/tests/compare_results" "$1/$3" "$2/$3" > differences || fail "$2: $3: $(cat differences)"; }

deck "model: multi-yield-j2, $clay" > home.yaml
"$breccia" run home.yaml > out 2>&1 || fail "home: $(cat out)"

# ---- the same bits wherever the law runs ----
serve "unix:$PWD/one" ; first=$server
serve "tcp://127.0.0.1:0"; second=$server
tcp=$(sed 's/listening at //' serve.out)
deck "$served, server: ['unix:$PWD/one', '$tcp']" > two.yaml
"$breccia" run two.yaml > out 2>&1 || fail "two servers: $(cat out)"
same home two results.vtkhdf
contains "overview tells what its time leaves out" "$(cat out)" " s and what its material servers take"
contains "outcome tells of servers" "$(cat out)" "server 2 of 2 at $tcp: "
"$breccia" run two.yaml --steps 30 > /dev/null 2>&1
"$breccia" run two.yaml --restart > out 2>&1 || fail "restart with servers: $(cat out)"
same home two results.vtkhdf
# A fresh server is given what the checkpoint saved.
"$breccia" run two.yaml --steps 30 > /dev/null 2>&1
server=$second; stop
server=$first; stop
serve "unix:$PWD/one"; first=$server
serve "$tcp"; second=$server
"$breccia" run two.yaml --restart --threads 1 > out 2>&1 || fail "restart with fresh servers: $(cat out)"
same home two results.vtkhdf
server=$second; stop

# The stable step that is measured again when bonds have broken: elastic answers begin at the last ones, as those of laws inside the program do.
torn() { deck "$1" | sed 's/^loads:/failure: {critical stretch: 0.02}\nloads:/; s/900/3000/g; s/ramp to: 1e-4/ramp to: 1e-3/; s/steps: 60/steps: 2001/; s/checkpoint steps: 20/checkpoint steps: 1000/'; }
torn "model: multi-yield-j2, $clay" > torn-home.yaml
torn "$served, server: ['unix:$PWD/one']" > torn-away.yaml
for where in home away; do "$breccia" run torn-$where.yaml > out 2>&1 || fail "torn, $where: $(cat out)"; done
same torn-home torn-away results.vtkhdf
steps=$(sed -n 's/.*"stable_time_step": \([^,]*\),/\1/p' torn-home/summary.json torn-away/summary.json | tr '\n' ' ')
echo "$steps" | awk '{exit !($1 > 0 && $1 - $2 < 1e-9 * $1 && $2 - $1 < 1e-9 * $1)}' || fail "stable steps inside the program and in a server: $steps"

# One point in the laboratory.
laboratory() { printf 'units: {length: m, force: kN, time: s}\nmaterial: {%s, density: 1.5}\ntest: {kind: triaxial, strain: 0.01, cycles: 1, confining pressure: 50}\n' "$1"; }
laboratory "model: multi-yield-j2, $clay" > test-home.yaml
laboratory "$served, server: ['unix:$PWD/one']" > test-away.yaml
"$breccia" material test-home.yaml > test-home.csv || fail "laboratory inside the program"
"$breccia" material test-away.yaml > test-away.csv 2> err || fail "laboratory in a server: $(cat err)"
equal "laboratory: rows" "$(wc -l < test-home.csv)" 402
cmp -s test-home.csv test-away.csv || fail "laboratory: $(diff test-home.csv test-away.csv | head -3)"
"$breccia" material test-away.yaml > again.csv; cmp -s again.csv test-home.csv || fail "laboratory: a point begins where another ended"

serve "udp://127.0.0.1:0"; udp=$(sed 's/listening at //' serve.out)
# A client that gives up takes leave, or the next one would be told that the server is busy.
deck "remote: jelly, server: ['$udp']" > jelly.yaml
"$breccia" run jelly.yaml > out 2>&1; equal "no such law over datagrams: status" $? 2
deck "$served, server: ['$udp']" > datagrams.yaml
"$breccia" run datagrams.yaml > out 2>&1 || fail "datagrams: $(cat out)"
same home datagrams results.vtkhdf
stop

# A command that counts stresses in another unit: the same numbers up to roundings.
deck "model: elastic, Young modulus: 1e5, Poisson ratio: 0.25" > elastic.yaml
deck "remote: elastic; Young modulus=1e8; Poisson ratio=0.25, stress unit: Pa, server: ['unix:$PWD/one']" > pascals.yaml
"$breccia" run elastic.yaml > out 2>&1 || fail "elastic: $(cat out)"
"$breccia" run pascals.yaml > out 2>&1 || fail "pascals: $(cat out)"
contains "overview tells the law" "$(cat out)" "correspondence; clay (elastic of a server); "
"$build/tests/compare_results" elastic/results.vtkhdf pascals/results.vtkhdf 1e-12 displacement stress > differences ||
  fail "pascals: $(cat differences)"

# Plane stress iterates with the server's tangents, block by block.
flat() { sed "s/cubic/square/; s/spacing: 0.03/spacing: 0.03, thickness: 0.06/; s/\[11, 9, 2\]/[11, 9]/; s/first particle: \[0, 0, 0\]/first particle: [0, 0]/
  s/{formulation: correspondence/{formulation: correspondence, space: plane stress/" "$1"; }
flat home.yaml > flat.yaml
deck "$served, server: ['unix:$PWD/one']" > served.yaml
flat served.yaml > flat-served.yaml
"$breccia" run flat.yaml > out 2>&1 || fail "flat: $(cat out)"
"$breccia" run flat-served.yaml > out 2>&1 || fail "flat, served: $(cat out)"
same flat flat-served results.vtkhdf

# Free strains: a law in a server receives strains less the free strains, too.
swollen() { sed 's/^loads:/&\n  - {on: {face: x+, layers: 4}, initial strain: 2e-4, history: {ramp to: 2e-4}}/' "$1"; }
swollen home.yaml > swollen.yaml
swollen served.yaml > swollen-served.yaml
"$breccia" run swollen.yaml > out 2>&1 || fail "swollen: $(cat out)"
"$breccia" run swollen-served.yaml > out 2>&1 || fail "swollen, served: $(cat out)"
same swollen swollen-served results.vtkhdf
"$build/tests/compare_results" home/results.vtkhdf swollen/results.vtkhdf 1e-6 stress > /dev/null &&
  fail "swollen: its free strain does nothing"

# Bonds, each with a law of one strain.
bonds() { deck "$1" | sed 's/correspondence, horizon/bond-based, strength of: bonds, horizon/; s/, zero-energy control: {silling: 0.1}//; s/900/2e5/g'; } # laws in servers have the strength that they are given
softening='Young modulus=3e7; tensile strength=3000; fracture energy=0.1; length=0.03'
bonds "model: bilinear-softening, Young modulus: 3e7, tensile strength: 3000, fracture energy: 0.1, length: 0.03" > bonds.yaml
bonds "remote: 'bilinear-softening; $softening', server: ['unix:$PWD/one']" > bonds-served.yaml
"$breccia" run bonds.yaml > out 2>&1 || fail "bonds: $(cat out)"
"$breccia" run bonds-served.yaml > out 2>&1 || fail "bonds, served: $(cat out)"
"$build/tests/compare_results" bonds/results.vtkhdf bonds-served/results.vtkhdf 1e-13 displacement stress damage > differences ||
  fail "bonds: $(cat differences)"

# ---- faults: one line, in time, and what was committed stays ----
relay() { # FAULT
  rm -f relay relay.connected
  python3 "$source/tests/command/faulty_relay.py" "$PWD/relay" "$PWD/one" "$1" 30 &
  relay=$!
  wait_for $relay [ -S relay ] || fail "the relay does not begin"
}
relayed() { deck "$served, server: ['unix:$PWD/relay'], timeout: $1"; }
fault() { # FAULT WORDS STEPS: those that are left for the restart; 32 after the last committed step, 40 after the last checkpoint
  left_out 3 && return # random answers meet the client under the sanitizers in make fuzz
  relay "$1"
  relayed ${4:-300} > faulty.yaml
  "$breccia" run faulty.yaml > out 2> err
  equal "$1: status" $? 1
  equal "$1: lines" "$(wc -l < err)" 1
  contains "$1: message" "$(cat err)" "step 29 (time 0.000232 s): material 'clay': server at unix:$PWD/relay: $2"
  [ -f faulty/checkpoint.h5 ] || fail "$1: no checkpoint"
  kill $relay 2> /dev/null; wait $relay 2> /dev/null
  # From the last checkpoint, with a server that is well, to the same end.
  relay none
  "$breccia" run faulty.yaml --restart > out 2>&1 || fail "$1: restart: $(cat out)"
  contains "$1: restart" "$(cat out)" " for $3 steps, "
  # A step taken back leaves roundings; from a checkpoint that a healthy run wrote on it is the same to the bit.
  if [ "$3" = 40 ]; then
    same home faulty results.vtkhdf
  else
    "$build/tests/compare_results" home/results.vtkhdf faulty/results.vtkhdf 1e-12 displacement velocity stress > differences ||
      fail "$1: $(cat differences)"
  fi
  kill $relay 2> /dev/null; wait $relay 2> /dev/null
}
fault close 'it has closed the connection' 40
fault hang 'it does not answer within 5 s' 40 5
fault length 'a frame of 1073741824 bytes was announced; the most is 268435456' 32
fault short 'it answered with 198 points in 9496 bytes where 198 points in 9504 bytes were due' 32
fault sequence 'it answered 133 to frame ' 32
fault nan 'it returned a stress that is not a number for its point 0' 32
fault damage 'a frame came damaged (its checksum does not hold)' 32
fault garbage 'what came is no frame of a material server (it begins with 48 54 54 50)' 32
fault version 'it speaks version 9 of the protocol, this program version 1' 32
relay late
relayed 300 > faulty.yaml
"$breccia" run faulty.yaml > out 2>&1 || fail "late: $(cat out)"
same home faulty results.vtkhdf
kill $relay 2> /dev/null; wait $relay 2> /dev/null

# Bars whose law runs in a server, in motion, at rest and slipping, and beside a body whose law runs in one: forces to the same bits, and energies as inside the program.
bars() { # STEEL KEYS SOLVE [BODY]
  cat << END
units: {length: m, force: kN, time: s}
materials:
  soft: {${4:-model: elastic-1d, Young modulus: 1e5}, density: 2}
  steel: {$1, density: 7}
body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}
peridynamics: {formulation: bond-based, calibration: uniform-expansion, horizon: 2.015 spacings}
bars:
  upper: {points: [[0.02, 0.14, 0.21], [1.18, 0.14, 0.21]], area: 1e-4, material: steel$2}
  lower: {points: [[0.02, 0.14, 0.11], [0.62, 0.14, 0.11]], area: 1e-4, material: steel$2}
loads:
  - {on: {face: x-, layers: 3}, displacement: [0, 0, 0]}
  - {on: {face: x+, layers: 3}, displacement: [12 mm, 0, 0], history: {table: [[0, 0], [0.1, 1], [0.2, -0.2]]}}
watch: {upper: {bar: upper}, lower: {bar: lower}}
solve: {$3}
results: {number: 2, precision: double, checkpoint steps: 4}
pictures: []
END
}
bond=', bond: {compressive strength: 30 MPa, rib spacing: 8 mm}'
tension='steel-bilinear; Young modulus=2e8; yield stress=5e5; hardening ratio=0.01'
steel="remote: '$tension', server: ['unix:$PWD/one']"
home='model: steel-bilinear, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01'
rest='static: {increments: 8, end time: 0.2}'
try_bars() { # NAME KEYS SOLVE [BODY]
  bars "$home" "$2" "$3" > "bars-$1.yaml"
  bars "$steel" "$2" "$3" "${4:-}" > "bars-$1-away.yaml"
  for where in "" -away; do "$breccia" run "bars-$1$where.yaml" > out 2>&1 || fail "bars-$1$where: $(cat out)"; done
  contains "bars, $1: the outcome tells of the server" "$(cat out)" "material 'steel': server at unix:$PWD/one: 18 points, "
  same_bars "bars-$1" "bars-$1-away" ${5:-0}
  for bar in upper lower; do nearly "bars-$1" "$bar"; done
}
same_bars() { # FOLDER FOLDER [TOLERANCE]
  "$build/tests/compare_results" "$1/results.vtkhdf" "$2/results.vtkhdf" "${3:-0}" displacement velocity stress strain > differences ||
    fail "$2: $(cat differences)"
}
nearly() { # FOLDER BAR: stored and dissipated energies are found by another way
  paste -d, "$1/$2.csv" "$1-away/$2.csv" | awk -F, -v n="$(head -1 "$1/$2.csv" | awk -F, '{print NF}')" '
    NR > 1 {for (k = 2; k <= n; ++k) {d = $k - $(n + k); if (d < 0) d = -d; s = $k < 0 ? -$k : $k; if (s > most[k]) most[k] = s; if (d > off[k]) off[k] = d}}
    END {for (k = 2; k <= n; ++k) if (off[k] > 1e-6 * most[k] + 1e-12) exit 1}' || fail "$1: $2: $(tail -n 1 "$1/$2.csv") and $(tail -n 1 "$1-away/$2.csv")"
}
try_bars motion '' 'explicit: {end time: 0.2, damping: 20 1/s}'
try_bars rest '' "$rest"
try_bars slip "$bond" "$rest"
serve "unix:$PWD/body"; second=$server
try_bars both '' 'explicit: {end time: 0.02, damping: 20 1/s}' "remote: elastic-1d; Young modulus=1e5, server: ['unix:$PWD/body']" 1e-9
server=$second; stop
for way in motion slip; do # from the middle, with what the server saved
  "$breccia" run bars-$way-away.yaml --steps 4 > out 2>&1
  "$breccia" run bars-$way-away.yaml --restart > out 2>&1 || fail "bars, $way: restart: $(cat out)"
  same_bars bars-$way bars-$way-away
done
# Steel that begins under stress: what it stores at first is in the books, and it yields when it does inside the program, after a restart too.
home='model: elastic-perfectly-plastic, Young modulus: 2e8, yield stress: 5e5, initial strain: -1e-3'
steel="remote: 'elastic-perfectly-plastic; Young modulus=2e8; yield stress=5e5; initial strain=-1e-3', server: ['unix:$PWD/one']"
try_bars stressed '' 'explicit: {end time: 0.2, damping: 20 1/s}'
try_bars stressed-rest '' "$rest"
try_bars stressed-slip "$bond" "$rest"
at_first() { sed -n 's/.*\( - stored at the start [^,]*\),.*/\1/p' out; } # 1e-4 m2 * 1.76 m * (2e5 kPa)^2 / (2 * 2e8 kPa)
equal "stored at first in a server" "$(at_first)" " - stored at the start 17.6 J"
"$breccia" run bars-stressed-away.yaml --steps 4 > out 2>&1
[ "$(json bars-stressed-away/summary.json yielded_share)" = 0 ] || fail "stressed bars yield before the restart, the test is too tame"
"$breccia" run bars-stressed-away.yaml --restart > out 2>&1 || fail "bars, stressed: restart: $(cat out)"
equal "stored at first, after a restart" "$(at_first)" " - stored at the start 17.6 J"
same_bars bars-stressed bars-stressed-away
for bar in upper lower; do nearly bars-stressed "$bar"; done

refuse_bars() { # STEEL KEYS WORDS [BODY]
  bars "$1" "$2" "$rest" "${4:-}" > refused.yaml
  "$breccia" run refused.yaml > out 2> err
  equal "refused bars: status" $? 2
  contains "refused bars" "$(head -n 1 err)" "$3"
}
refuse_bars "remote: j2; Young modulus=2e8; Poisson ratio=0.3; yield stress=4e5, server: ['unix:$PWD/one']" '' \
  "material: 'steel' is 'j2 of a server', a law of strain in space; bars take laws of one strain"
sed 's/material: soft, spacing/material: steel, spacing/' bars-rest-away.yaml > refused.yaml
"$breccia" run refused.yaml > out 2> err; equal "shared: status" $? 2
contains "shared" "$(cat err)" "material: 'steel' runs in a server, which holds the points of block 'b' with it; give bars a material of their own"
# A server that is lost in the middle of bars.
relay close
sed "s:unix.*/one:unix\:$PWD/relay:" bars-motion-away.yaml > lost.yaml
"$breccia" run lost.yaml > out 2> err; equal "lost: status" $? 1
equal "lost: lines" "$(wc -l < err)" 1
contains "lost" "$(cat err)" "material 'steel': server at unix:$PWD/relay: it has closed the connection"
kill $relay 2> /dev/null; wait $relay 2> /dev/null
"$breccia" run lost.yaml --restart > out 2> err; equal "lost for good: status" $? 2
relay none
"$breccia" run lost.yaml --restart > out 2>&1 || fail "lost: restart: $(cat out)"
same_bars bars-motion lost
kill $relay 2> /dev/null; wait $relay 2> /dev/null

refuse() { # MATERIAL WORDS
  deck "$1" > refused.yaml
  "$breccia" run refused.yaml > out 2> err
  equal "refused: status" $? 2
  equal "refused: lines of: $(cat err)" "$(wc -l < err)" 1
  contains "refused" "$(cat err)" "$2"
}
refuse "$served, server: ['unix:$PWD/nobody']" "material 'clay': server at unix:$PWD/nobody: it cannot be reached: No such file"
refuse "$served, server: ['gopher://x']" "server at gopher://x: it cannot be reached: an address is tcp://HOST:PORT, udp://HOST:PORT or unix:/PATH"
refuse "$served" "refused.yaml:3:18: remote: give the addresses of its servers under 'server'"
refuse "remote: jelly, server: ['unix:$PWD/one']" "there is no law 'jelly'; a command is 'LAW; KEY=VALUE; ...' with one of elastic, j2, "
refuse "remote: j2; Young modulus=1, server: ['unix:$PWD/one']" "missing 'yield stress=...'"
refuse "$served; bulk modulus=1, server: ['unix:$PWD/one']" "bulk modulus=1: is given twice"
refuse "remote: elastic-1d; Young modulus=1, server: ['unix:$PWD/one']" "'elastic-1d; Young modulus=1' is a law of one strain; correspondence takes elastic,"
refuse "opensees: nDMaterial ElasticIsotropic3D 1 1e5 0.3" "opensees: expected 'nDMaterial KIND \$tag ...'"
refuse "opensees: 'nDMaterial X \$tag [exec rm]'" "opensees: expected 'nDMaterial KIND \$tag ...'"
refuse "$served, model: elastic, Young modulus: 1, Poisson ratio: 0, server: ['unix:$PWD/one']" "more than one of 'model', 'opensees', 'remote' is given; give exactly one"
refuse "$served, jelly: 3, server: ['unix:$PWD/one']" "unknown key 'jelly'"
# Folders for sockets of servers of the program's own go with them, however these end.
mkdir sockets
export TMPDIR=$PWD/sockets
BRECCIA_OPENSEES=$PWD/nowhere refuse "opensees: nDMaterial ElasticIsotropic3D \$tag 1e5 0.3, processes: 2" "OpenSees server 1 of 2: '$PWD/nowhere' cannot be started: No such file or directory; \`make demo-opensees\` sets one up"
printf '#!/bin/sh\necho out of cheese >&2\nexit 3\n' > ends; chmod +x ends
BRECCIA_OPENSEES=$PWD/ends refuse "opensees: nDMaterial ElasticIsotropic3D \$tag 1e5 0.3, processes: 1" "its process has ended with status 3; its last words: out of cheese"

# What a server offers is listed; one that cannot be started is told of.
printf '#!/bin/sh\nexec "%s" serve "$@"\n' "$breccia" > lists; chmod +x lists
contains "offers" "$(BRECCIA_OPENSEES=$PWD/lists "$breccia" models --opensees 2>&1)" " drucker-prager "
BRECCIA_OPENSEES=$PWD/nowhere "$breccia" models --opensees > out 2> err; equal "no offers: status" $? 2
contains "no offers" "$(cat err)" "OpenSees server: '$PWD/nowhere' cannot be started"
equal "folders of sockets that stay behind" "$(ls sockets)" ""
unset TMPDIR

# Two clients at once: the second is turned away, and the first goes on.
relay hang
"$breccia" run faulty.yaml > /dev/null 2>&1 & client=$!
wait_for $client [ -e relay.connected ] || fail "the first client does not begin"
refuse "$served, server: ['unix:$PWD/one']" "server at unix:$PWD/one: the server is busy with another client"
kill $relay $client 2> /dev/null; wait $relay $client 2> /dev/null

# Addresses that are taken, or that others could reach.
"$breccia" serve --listen "unix:$PWD/one" > out 2> err; equal "taken: status" $? 2
contains "taken" "$(cat err)" "unix:$PWD/one: cannot be listened to: Address already in use"
"$breccia" serve --listen tcp://0.0.0.0:0 > out 2> err; equal "open: status" $? 2
contains "open" "$(cat err)" "a server listens on this machine only, unless a secret guards it (--secret-file)"
equal "socket for its owner only" "$(stat -c %a one)" 600
server=$first; stop
[ -e one ] && fail "the socket's file stays behind"

# The socket's file goes at any end; a number that is no port is refused.
for signal in TERM INT HUP; do
  serve "unix:$PWD/ended"
  kill -$signal "$server"; wait "$server"; equal "status at the end by SIG$signal" $? 0
  [ -e ended ] && fail "the socket's file stays behind after SIG$signal"
done
"$breccia" serve --listen tcp://127.0.0.1:99999 > out 2> err; equal "no port: status" $? 2
equal "no port" "$(cat err)" "tcp://127.0.0.1:99999: cannot be listened to: '99999' is no port: expected a number from 0 to 65535"
refuse "$served, server: ['tcp://127.0.0.1:99999']" "server at tcp://127.0.0.1:99999: it cannot be reached: '99999' is no port: expected a number from 1 to 65535"

# A secret.
echo sesame > secret
serve tcp://127.0.0.1:0 --secret-file secret; tcp=$(sed 's/listening at //' serve.out)
refuse "$served, server: ['$tcp']" "server at $tcp: the secret is wrong"
deck "$served, server: ['$tcp']" > guarded.yaml
BRECCIA_SECRET=sesame "$breccia" run guarded.yaml > out 2>&1 || fail "secret: $(cat out)"
same home guarded results.vtkhdf
stop

# Killed in the middle of a run.
serve "unix:$PWD/one"
relay hang
deck "$served, server: ['unix:$PWD/relay'], timeout: 300" > killed.yaml
"$breccia" run killed.yaml > out 2> err & client=$!
wait_for $client [ -f killed/checkpoint.h5 ] || fail "killed: no checkpoint"
kill -9 "$server"; kill -9 $relay; wait "$server" 2> /dev/null
wait $client; equal "killed: status" $? 1
contains "killed" "$(cat err)" "material 'clay': server at unix:$PWD/relay: it has closed the connection"
serve "unix:$PWD/one" # over the file that the killed one left
relay none
"$breccia" run killed.yaml --restart > out 2>&1 || fail "killed: restart: $(cat out)"
same home killed results.vtkhdf
stop
kill $relay 2> /dev/null
wait 2> /dev/null
finish

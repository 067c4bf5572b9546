# `make examples`: an example of the project, and a small project whose examples keep to what is accepted, do not, and fail.
. "$(dirname "$0")/common.sh"

# A quick one of the project: its own page stays as it is, and the page of all has its tables and pictures.
before=$(cksum "$source"/examples/gravity-column/README.md)
python3 -B "$source/scripts/examples.py" --page "$work/page.html" "$source" "$(dirname "$breccia")" "$work/copy" gravity-column > "$work/out" 2>&1 ||
  fail "gravity-column: $(cat "$work/out")"
equal "the page of the example itself" "$(cksum "$source"/examples/gravity-column/README.md)" "$before"
contains "the page" "$(cat "$work/page.html")" "<th class=\"\">deviation (accepted -1 to 1)</th>"
equal "pictures of the page" "$(grep -c 'src="data:image/png;base64,' "$work/page.html")" "$(grep -c '!\[' "$source/examples/gravity-column/README.md")"

# A project with four examples; their scripts write 'kept' pages.
example() { # NAME COMPUTED: the page of an example, and a script that writes what it computes
  mkdir -p "$work/project/examples/$1/pictures"
  cat > "$work/project/examples/$1/README.md" << END
# The $1 one

<!-- loads -->

| | published | by hand | computed | accepted |
|---|---|---|---|---|
| load, kN | 5 | 5.2 | 4.9 to 5.1 | 4 to 6 |
| under 5 kN | a crack | | failed | failed |
| crack, mm | 2 | | 2.1 | 1 to 3 |
| time for one load | 33 min | | 9 s | |

| | beside the test (accepted -5 to 5) | which of two cracks (± 5 m) |
|---|---|---|
| small | +3.1 % | 40 m |

| | ours | theirs | difference | band |
|---|---|---|---|---|
| frequency | 1 | 1.01 | -0.5 % | 1 % |

<!-- end of loads -->
END
  printf '%s\n' "$2" > "$work/project/examples/$1/report.sh"
}
example same 'sed -i "s/9 s/12 s/; s/5.1/5.11/; s/40 m/44.9 m/" README.md; test -x ../../build/release/breccia; test ! -L ../../docs; test -e ../../docs/other.md; test "$OMP_NUM_THREADS" -ge 1'
example other 'sed -i "s/4.9 to 5.1/4.7 to 5.1/; s/40 m/45.1 m/" README.md'
example outside 'sed -i "s/4.9 to/3.9 to/; s/| failed | failed/| steady | failed/; s/+3.1/+5.2/; s/-0.5 %/-1.5 %/; s/| 2.1 |/| none |/" README.md'
example broken 'echo "no <such> command"; exit 3'
mkdir "$work/project/docs" "$work/project/examples/same/results"
touch "$work/project/docs/other.md" "$work/project/examples/same/results/old"
report() { # EXPECTED STATUS, then options and names
  local expected=$1 status=0
  shift
  (cd "$work/project" && python3 -B "$source/scripts/examples.py" "$@") > "$work/out" 2>&1 || status=$?
  equal "status of $*" "$status" "$expected"
}
report 1 . "$(dirname "$breccia")" build/examples
page=$(cat "$work/project/examples/report.html")
contains "all" "$(cat "$work/out")" "broken: FAILED with 3; "
contains "after one that failed" "$(cat "$work/out")" "other: 2 not as in README.md; "
contains "out of five bands" "$(cat "$work/out")" "outside: 5 outside of what is accepted, 5 not as in README.md; "
contains "times and a hundredth" "$(cat "$work/out")" "same: good; "
contains "the page" "$page" '<tr class="red"><td><a href="#broken">broken</a></td>'
contains "the page" "$page" '<tr class="changed"><td><a href="#other">other</a></td>'
contains "the page" "$page" '<tr class=""><td><a href="#same">same</a></td>'
contains "what a script said" "$page" '<pre>no &lt;such&gt; command'
equal "red cells" "$(grep -o '<td class="red">' "$work/project/examples/report.html" | wc -l)" 5
contains "a red cell" "$page" '<td class="red">3.9 to 5.1</td>'
contains "a red word" "$page" '<td class="red">steady</td>'
contains "a red share" "$page" '<td class="red">+5.2 %</td>'
contains "a red difference" "$page" '<td class="red">-1.5 %</td><td class="">1 %</td>'
contains "the time of all" "$page" '<td>together</td>'
equal "results of former runs" "$([ -e "$work/project/build/examples/examples/same/results" ] && echo copied)" ""
report 0 . "$(dirname "$breccia")" build/examples same other
report 1 . "$(dirname "$breccia")" build/examples outside
report 1 . "$(dirname "$breccia")" build/examples broken
report 1 --strict . "$(dirname "$breccia")" build/examples same other
report 0 --strict . "$(dirname "$breccia")" build/examples same
report 1 --strict --minutes 0 . "$(dirname "$breccia")" build/examples same
contains "a time beyond what is allowed" "$(cat "$work/out")" ", beyond 0 minutes"
report 0 --minutes 0 . "$(dirname "$breccia")" build/examples same
example first 'for n in $(seq 100); do test -e ../second/begun && exit; sleep 0.1; done; exit 1'
example second 'touch begun'
report 0 --at-once 2 . "$(dirname "$breccia")" build/examples first second # one waits for the other
rm -r "$work/project/examples/first" "$work/project/examples/second"
report 1 . "$(dirname "$breccia")" build/examples another
contains "an example that is not there" "$(cat "$work/out")" "there is no example 'another' with a report.sh; there are broken, other, outside, same"

# Hand calculations of ACI 318 beside sums over the fibres of a section.
python3 -B - "$source/examples" > "$work/out" 2>&1 << 'END' || fail "aci318: $(cat "$work/out")"
import sys
sys.path.insert(0, sys.argv[1])
from aci318 import block_depth, cracking_moment, deep_shear_limit, nominal_moment, rupture, shear_strength
width, height, depth, steel, fy, fc, strength, count = 20, 15, 13.5, 1.374, 60e3, 4e3, 251, 20000
fibres = [(n + 0.5) * height / count for n in range(count)]  # places below the top
area = width * height / count
linear = sum(strength * (y - height / 2) / (height / 2) * area * (y - height / 2) for y in fibres)
assert abs(linear / cracking_moment(strength, width, height) - 1) < 1e-6, linear
pressed = [y for y in fibres if y < block_depth(steel, fy, fc, width)]
assert abs(0.85 * fc * area * len(pressed) - steel * fy) < 0.85 * fc * area, len(pressed)
moment = sum(0.85 * fc * area * (depth - y) for y in pressed)
assert abs(moment / nominal_moment(steel, fy, fc, width, depth) - 1) < 2e-3, moment
assert abs(shear_strength(fc, width, depth) - 34153) < 1 and abs(deep_shear_limit(fc, 12, 10) - 75895) < 1  # 34.15 and 75.9 kips
assert abs(rupture(fc) - 474.3) < 0.1
END
checks=$((checks + 1))
finish

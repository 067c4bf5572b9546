# The nightly checks with programs in place of make, sh and python3 that fail on demand: every step runs whatever the ones before found, and the
# table compares each step with its own last run.
. "$(dirname "$0")/common.sh"
mkdir -p "$work/tree/.ci" "$work/tree/docs" "$work/tools"
cp "$source/.ci/nightly" "$work/tree/.ci"
cd "$work/tree" || exit 1
git init -q . 2> /dev/null
echo "full counts" > docs/reliability.md
bash=$(command -v bash)
for tool in make sh python3; do
  cat > "$work/tools/$tool" <<T
#!$bash
echo "$tool \$*"
if [ "\$1" = torture ]; then
  page=docs/reliability.md
  for word in "\$@"; do case \$word in PAGE=*) page=\${word#PAGE=} ;; esac; done
  echo "short counts" > "\$page"
fi
if [ "\$1" = "\${HELD:-none}" ]; then
  touch held
  while [ ! -e released ]; do sleep 0.05; done
fi
case " \$* " in *" \${BROKEN:-none} "*) cat "\${WORDS:-$work/words}"; exit 2 ;; esac
[ "\$1" != bench-beside ] || echo "warning: slower than 1234567: elastic, forces: 1.10 times"
T
  chmod +x "$work/tools/$tool"
done
echo "2 tests failed out of 9" > "$work/words"
night() { PATH=$work/tools:$PATH bash .ci/nightly "$@" > out 2>&1; }
table() { sed -n '/^== what changed ==$/,$p' out; }
row() { table | grep "^$1 "; }
kept() { grep "^$1," build/nightly/last.csv; }

night; equal "all good: status" $? 0
steps=$(cut -d, -f1 build/nightly/last.csv | paste -sd" ")
for name in packages tests pairs sanitizers torture debian13 opensees bench examples; do contains "steps" " $steps " " $name "; done
contains "the first night: tests" "$(row tests)" "good"
case $(row tests) in *last*) fail "the first night knows a run before: $(row tests)" ;; esac
contains "what changed" "$(table)" "warning: slower than 1234567"

BROKEN=asan night; equal "sanitizers fail: status" $? 1
equal "sanitizers fail: steps" "$(cut -d, -f1 build/nightly/last.csv | paste -sd" ")" "$steps"
contains "sanitizers fail" "$(row sanitizers)" "FAILED"
contains "sanitizers fail" "$(row sanitizers)" "(last run: good,"
contains "sanitizers fail" "$(row sanitizers)" "CHANGED"
contains "sanitizers fail: reason" "$(table)" "2 tests failed out of 9"
contains "sanitizers fail: the step behind" "$(row torture)" "good"
case $(row torture) in *CHANGED*) fail "an unchanged step counts as changed: $(row torture)" ;; esac

# A single step is compared with its own last run, and the others keep theirs.
night tests; equal "tests alone: status" $? 0
equal "tests alone: rows" "$(table | grep -c ' s ')" 1
case $(cat out) in *slower*) fail "a bench that did not run is told: $(cat out)" ;; esac
BROKEN=asan night sanitizers; equal "sanitizers fail again: status" $? 1
contains "sanitizers fail again" "$(row sanitizers)" "(last run: FAILED,"
case $(row sanitizers) in *CHANGED*) fail "a step that fails again counts as changed: $(row sanitizers)" ;; esac
night sanitizers; equal "sanitizers are good again: status" $? 0
contains "sanitizers are good again" "$(row sanitizers)" "CHANGED"

# The list names what made a step shorter, in this run and the last one.
TORTURE_MINUTES=10 EXAMPLES="slope footing" night torture examples; equal "shorter steps: status" $? 0
contains "shorter torture" "$(row torture)" " s, TORTURE_MINUTES=10 "
contains "shorter examples" "$(row examples)" " s, EXAMPLES=slope footing "
night torture
contains "whole torture after a shorter one" "$(row torture)" "s, TORTURE_MINUTES=10)"
equal "the other step keeps its limits" "$(kept examples | cut -d, -f4)" "EXAMPLES=slope footing"

# The page with the full counts remains as it was.
equal "page of counts" "$(cat docs/reliability.md)" "full counts"
contains "counts" "$(cat "$(table | sed -n 's/^ *counts: //p')" 2>&1)" "short counts"
contains "page of make torture" "$(make -n -C "$source" torture PAGE=elsewhere.md)" "torture.py elsewhere.md"
contains "page of make torture without PAGE" "$(make -n -C "$source" torture)" "torture.py docs/reliability.md"

# Reasons of failures: lines that count none of them do not hide the one that counts some.
{ echo "killed runs: 1000 tried, 1 lost (3.0 min)"; for n in 2 3 4 5 6 7 8 9; do echo "part $n: 10 tried, 0 lost (1.0 min)"; done; } > "$work/torture"
BROKEN=torture WORDS=$work/torture night torture
contains "torture fails: reason" "$(table)" "1000 tried, 1 lost"
case $(table) in *" 0 lost"*) fail "parts that lost nothing are told: $(table)" ;; esac
printf '%s\n' "slope: good; 3 s" "footing: 2 outside of what is accepted, 1 not as in README.md; 4 s" "together: 7 s" > "$work/examples"
BROKEN=examples WORDS=$work/examples night examples
contains "examples fail: reason" "$(table)" "footing: 2 outside of what is accepted"

# An unknown step is refused before any step runs.
night tests asna; equal "no such step: status" $? 2
contains "no such step" "$(cat out)" "no step 'asna'; the steps are $steps"
case $(cat out) in *"== tests =="*) fail "a step runs before the message about an unknown one" ;; esac

# A second run at the same time is refused. A run that is killed in a later step has kept the results of finished ones.
BROKEN=asan night sanitizers; equal "sanitizers fail a third time: status" $? 1
HELD=torture PATH=$work/tools:$PATH bash .ci/nightly > first 2>&1 &
first=$!
wait_for $first test -e held
night tests; equal "second run at the same time: status" $? 2
contains "second run at the same time" "$(cat out)" "another nightly run"
kill $first
wait $first 2> /dev/null
touch released
until flock --nonblock build/nightly/lock true; do sleep 0.05; done
contains "killed run: a finished step" "$(kept sanitizers)" "sanitizers,good,"
equal "killed run: all steps" "$(cut -d, -f1 build/nightly/last.csv | sort | paste -sd" ")" "$(echo "$steps" | tr ' ' '\n' | sort | paste -sd" ")"
night tests; equal "a run after a killed one: status" $? 0
finish

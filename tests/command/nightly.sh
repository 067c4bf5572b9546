# The nightly checks with programs in place of make, sh and python3 that fail on demand: every step runs whatever the ones before found, and the
# table compares each step with its own last run.
. "$(dirname "$0")/common.sh"
mkdir -p "$work/tree/.ci" "$work/tools"
cp "$source/.ci/nightly" "$work/tree/.ci"
cd "$work/tree" || exit 1
git init -q . 2> /dev/null
bash=$(command -v bash)
for tool in make sh python3; do
  cat > "$work/tools/$tool" <<T
#!$bash
echo "$tool \$*"
case " \$* " in *" \${BROKEN:-none} "*) echo "2 tests failed out of 9"; exit 2 ;; esac
[ "\$1" != bench-beside ] || echo "warning: slower than 1234567: elastic, forces: 1.10 times"
T
  chmod +x "$work/tools/$tool"
done
night() { PATH=$work/tools:$PATH bash .ci/nightly "$@" > out 2>&1; }
row() { sed -n '/^== what changed ==$/,$p' out | grep "^$1 "; }

night; equal "all good: status" $? 0
steps=$(cut -d, -f1 build/nightly/last.csv | paste -sd" ")
for name in packages tests pairs sanitizers torture debian13 opensees bench examples; do contains "steps" " $steps " " $name "; done
contains "the first night: tests" "$(row tests)" "good"
case $(row tests) in *before*) fail "the first night knows a night before: $(row tests)" ;; esac
contains "what changed" "$(sed -n '/^== what changed ==$/,$p' out)" "warning: slower than 1234567"

BROKEN=asan night; equal "sanitizers fail: status" $? 1
equal "sanitizers fail: steps" "$(cut -d, -f1 build/nightly/last.csv | paste -sd" ")" "$steps"
contains "sanitizers fail" "$(row sanitizers)" "FAILED"
contains "sanitizers fail" "$(row sanitizers)" "(the night before: good,"
contains "sanitizers fail" "$(row sanitizers)" "CHANGED"
contains "sanitizers fail: reason" "$(sed -n '/^== what changed ==$/,$p' out)" "2 tests failed out of 9"
contains "sanitizers fail: the step behind" "$(row torture)" "good"
case $(row torture) in *CHANGED*) fail "an unchanged step counts as changed: $(row torture)" ;; esac

# A single step is compared with its own last run, and the others keep theirs.
night tests; equal "tests alone: status" $? 0
equal "tests alone: rows" "$(sed -n '/^== what changed ==$/,$p' out | grep -c ' s ')" 1
case $(cat out) in *slower*) fail "a bench that did not run is told: $(cat out)" ;; esac
BROKEN=asan night sanitizers; equal "sanitizers fail again: status" $? 1
contains "sanitizers fail again" "$(row sanitizers)" "(the night before: FAILED,"
case $(row sanitizers) in *CHANGED*) fail "a step that fails again counts as changed: $(row sanitizers)" ;; esac
night sanitizers; equal "sanitizers are good again: status" $? 0
contains "sanitizers are good again" "$(row sanitizers)" "CHANGED"

night tests asna; equal "no such step: status" $? 2
contains "no such step" "$(cat out)" "no step 'asna'; the steps are $steps"
finish

# What people type. CMake does the work (CMakePresets.json); this says it in short.
cores := $(shell nproc 2>/dev/null || echo 2)
jobs := $(shell expr $(cores) + 1)# tests at a time: some wait for sockets and servers

.PHONY: all setup demo demo-opensees test pairs test-external bench bench-peers bench-servers bench-beside bench-rest bench-bars bench-toughness bench-bending bench-choosing bench-elements bench-report recovery examples docs format check-format asan tsan arm64 debian13 coverage clang clang-test fuzz torture mutants install clean

all:
	@cmake --preset release > build-log.txt 2>&1 || { cat build-log.txt; echo "Missing packages? 'make setup' installs them."; exit 1; }
	@rm -f build-log.txt
	@cmake --build --preset release --parallel $(cores)

setup:
	@sh scripts/setup.sh build

# The plate of clay and the elastic plate of the first example, with steps four times as long.
demo: setup
	@cmake --preset release > /dev/null
	@cmake --build --preset release --target breccia_command --parallel $(cores)
	@sh scripts/demo.sh

# The same plate of clay with its law in OpenSees: 2.05e8 stresses through a socket, a quarter of an hour on two cores.
demo-opensees: setup all
	@sh scripts/opensees.sh
	@build/release/breccia run examples/plate-with-crack/clay-opensees.yaml

# All examples, or some: `make examples EXAMPLES="beam-plain footing"`. One page of computed beside published, examples/report.html; pages of examples stay as they are.
# Some need OpenSees (scripts/opensees.sh). STRICT=1: figures that are not as in these pages count as failures, too.
examples: all
	@python3 -B scripts/examples.py $(if $(STRICT),--strict) . build/release build/examples $(EXAMPLES)

# Most tests, some minutes; all tests: `make test ALL=1`; those of some matters (folders of tests/unit, and the scripts that go with them) or of some
# names: `make test TESTS="laws restart"`. Builds what these need, runs them, and prints the ten that took longest.
test:
	@sh scripts/setup.sh test
	@ALL=$(ALL) sh scripts/tests.sh test $(TESTS)

# Other people's programs from the Python index, in an environment of the project's own.
test-external:
	@sh scripts/setup.sh test
	@sh tests/external/run.sh

bench: setup all
	@build/release/breccia_bench build/release/bench.csv
	@build/release/breccia_bench_laws

# The same law inside the program, in a server of our own and in OpenSees; the table of docs/material-server.md.
bench-servers: setup all
	@sh scripts/opensees.sh
	@python3 bench/servers.py build/release/breccia docs/material-server.md

# Parameters found again from points of known ones; the table of docs/laboratory.md.
recovery: all
	@python3 bench/recovery.py build/release/breccia docs/laboratory.md

# The same bodies and laws by the program of another commit (COMMIT=..., the one before), in turn; tells what takes 5 % longer.
bench-beside: all
	@python3 -B bench/beside.py build/release/breccia_bench $(COMMIT)

# LAMMPS from the distribution, on the same cubes in the same run.
bench-peers: all
	@sh scripts/setup.sh peers
	@build/release/breccia_peers

# What equations of bodies at rest cost, and what check tells of runs; two tables of docs/performance.md.
bench-rest: all
	@python3 -B bench/bodies_at_rest.py build/release docs/performance.md

# Bars pulled apart by every formulation and softening law, beside their fracture energy; a quarter of an hour.
bench-bars: all
	@build/release/breccia_bench_bars

# Notched strips opened by a wedge, by formulation, law or criterion and direction; a table of docs/choosing.md; some minutes. ROWS=all: all lattices, horizons and directions,
# hours; ROWS="hybrid 45": rows with these words, printed.
bench-toughness: all
	@python3 -B bench/toughness.py build/release/breccia docs/choosing.md $(ROWS)

# Plain beams of softening bonds and links beside a cohesive crack; a table of docs/choosing.md; half an hour. ROWS="hybrid mazars": rows with these words, printed.
bench-bending: all
	@python3 -B bench/bending.py build/release/breccia docs/choosing.md $(ROWS)

# Bending at high Poisson ratios, strips that crack, pressed prisms, vertical cuts, factors of safety: five tables of
# docs/choosing.md; ten minutes of a processor.
# TABLES="strips cuts": these alone.
bench-choosing: all
	@python3 -B bench/choosing.py build/release/breccia docs/choosing.md $(TABLES)

# Elastic bodies at rest beside finite elements of OpenSees; a table of docs/performance.md.
bench-elements: all
	@sh scripts/opensees.sh
	@.venv/opensees/bin/python bench/finite_elements.py build/release/breccia docs/performance.md

# The tables of docs/performance.md for this machine; a quarter of an hour.
bench-report: all
	@sh scripts/setup.sh peers
	@python3 -B bench/report.py build/release docs/performance.md

# Pages and pictures that the program makes itself.
docs: all
	@sh scripts/docs.sh

format:
	@clang-format -i $$(git ls-files '*.c' '*.h')
check-format:
	@clang-format --dry-run --Werror $$(git ls-files '*.c' '*.h')

# Most tests, or with ALL=1 all, under the address and undefined-behaviour sanitizers.
asan:
	@sh scripts/setup.sh test
	@ALL=$(ALL) sh scripts/tests.sh asan-ubsan $(TESTS)

# Every pair of levels of the factors of tests/relations/pair_decks.py; `make pairs PAIRS="--all --only WORDS"`: decks of some levels.
pairs:
	@sh scripts/setup.sh test
	@cmake --preset test > /dev/null
	@cmake --build --preset test --target breccia_command print_results --parallel $(cores)
	@python3 -B tests/relations/pairs.py build/test/breccia build/test/tests/print_results --jobs $(cores) $(or $(PAIRS),--all)

# What works on several threads, under clang's thread sanitizer. It wants addresses where it looks for them: setarch, where that is allowed.
tsan:
	@sh scripts/setup.sh test
	@$$(setarch -R true 2> /dev/null && echo setarch -R) sh scripts/tests.sh tsan threads

# Built for arm64 on another machine, without warnings; some quick tests of it under an emulator. Servers are none of these: programs that it starts are for this machine.
arm64_tests := test_golden test_elastic_first test_bar test_faces test_many test_springs_and_ties test_hybrid_strain test_micropolar test_carried_reactions test_checkpoint test_result_file
arm64:
	@sh scripts/arm64.sh
	@cmake --preset arm64 > /dev/null
	@cmake --build --preset arm64 --target breccia_command $(addprefix tests_of_,$(arm64_tests)) --parallel $(cores)
	@ctest --preset arm64 --parallel $(jobs) -R '^($(subst $() ,|,$(arm64_tests)))$$'

# Builds the program and runs all tests on Debian 13, in a system of its own (scripts/debian13.sh); needs root or sudo.
debian13:
	@sh scripts/debian13.sh make test ALL=1 TESTS="$(TESTS)"

coverage:
	@sh scripts/setup.sh test
	@cmake --preset coverage > /dev/null
	@cmake --build --preset coverage --parallel $(cores)
	@ctest --preset coverage
	@gcovr -r . --filter source build/coverage --print-summary

# A second compiler, warnings as errors.
clang:
	@cmake --preset clang > /dev/null
	@cmake --build --preset clang --parallel $(cores)

# The unit tests with what it makes. It has no vector clones (base/lanes.h says why): the plain version of the sweeps is tested here.
clang-test:
	@sh scripts/setup.sh test
	@cmake --preset clang-test > /dev/null
	@cmake --build --preset clang-test --parallel $(cores)
	@ctest --preset clang-test --parallel $(cores)

# The deck reader against random decks, small models of such decks for some steps, then both sides of the protocol of material servers against
# random frames, for FUZZ_SECONDS each.
fuzz:
	@sh scripts/setup.sh test
	@cmake --preset asan-ubsan > /dev/null
	@cmake --build --preset asan-ubsan --target fuzz_deck fuzz_model fuzz_server fuzz_client --parallel $(cores)
	@sh tests/fuzz/run.sh $(or $(FUZZ_SECONDS),60)

# The tests that inject faults, by the thousand, for about TORTURE_MINUTES (60); remakes the table of docs/reliability.md, or of PAGE.
torture:
	@sh scripts/setup.sh test
	@cmake --preset test > /dev/null
	@cmake --build --preset test --parallel $(cores)
	@cmake --preset asan-ubsan > /dev/null
	@cmake --build --preset asan-ubsan --target fuzz_deck fuzz_model fuzz_server fuzz_client --parallel $(cores)
	@python3 -B tests/torture.py $(or $(PAGE),docs/reliability.md)

# Small faults in lines that differ from BASE, one at a time; prints those that no test notices. 20 of them and half an hour, unless told otherwise:
# `make mutants BASE=HEAD~3 COUNT=5 SEED=2 MINUTES=10 TESTS='test_deck|reuse'`. No part of CI: what survives is to be judged.
mutants:
	@sh scripts/setup.sh test
	@sh tests/mutants/run.sh $(if $(BASE),--base $(BASE)) $(if $(COUNT),--count $(COUNT)) $(if $(SEED),--seed $(SEED)) \
	  $(if $(MINUTES),--minutes $(MINUTES)) $(if $(TESTS),--tests '$(TESTS)')

install: all
	@cmake --install build/release $(if $(PREFIX),--prefix "$(PREFIX)")

clean:
	@rm -rf build

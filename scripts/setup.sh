#!/bin/sh
# Installs what is missing from the distribution's packages (Debian, Ubuntu). Asks nothing; does nothing when all is there.
#   setup.sh build   what the program needs
#   setup.sh test    what its tests need besides
#   setup.sh peers   the programs that it is measured against
#   setup.sh opensees   what OpenSees from the Python index needs
#   setup.sh arm64   what builds for arm64 on another machine (scripts/arm64.sh)
#   setup.sh debian13   what makes a system of Debian 13 to test in (scripts/debian13.sh)
#   setup.sh libraries   prints which libraries program and tests are linked with, and installs nothing
set -eu

build="gcc:C_compiler cmake:build ninja-build:build pkg-config:build libc6-dev:C_library libfyaml-dev:decks_in_YAML
libudunits2-dev:units libhdf5-dev:result_files libcairo2-dev:pictures fonts-dejavu-core:words_in_pictures
gnuplot-nox:curves zlib1g-dev:checksums libmumps-seq-dev:direct_solution_of_equations libarpack2-dev:modes_of_vibration libopenblas0-serial:speed_of_direct_solution"
test="libcmocka-dev:unit_tests clang:second_compiler_and_fuzzing libclang-rt-dev:fuzzing lld:quick_linking_of_tests clang-format:layout_of_the_code gcovr:coverage ccache:repeated_compilations
python3:external_tests python3-venv:external_tests locales:a_country_with_decimal_commas"

peers="lammps:its_PERI_package"
arm64="gcc-aarch64-linux-gnu:compiler_for_arm64 libc6-dev-arm64-cross:compiler_for_arm64 qemu-user:emulator mmdebstrap:libraries_for_arm64"
debian13="mmdebstrap:system_of_Debian_13"
opensees="python3:OpenSees python3-venv:OpenSees python3-tk:OpenSees libblas3:OpenSees libmimalloc-dev:speed_of_OpenSees"

if [ "${1:-build}" = libraries ]; then
  for entry in $build $test; do echo "${entry%%:*}"; done | sed -n '/^libclang/d; /^lib.*-dev$/p; /^zlib/p; /^libopenblas/p' | paste -sd, -
  exit 0
fi
wanted=$build
[ "${1:-build}" = arm64 ] && wanted="$build $arm64"
[ "${1:-build}" = debian13 ] && wanted="$debian13"
[ "${1:-build}" = peers ] && wanted="$build $peers"
[ "${1:-build}" = test ] && wanted="$build $test"
[ "${1:-build}" = opensees ] && wanted="$build $opensees"

missing="" why=""
for entry in $wanted; do
  package=${entry%%:*} purpose=$(echo "${entry#*:}" | tr _ ' ')
  dpkg-query -W -f '${Status}' "$package" 2> /dev/null | grep -q 'install ok installed' && continue
  missing="$missing $package"
  why="$why $package ($purpose)"
done
[ -z "$missing" ] && exit 0

if ! command -v apt-get > /dev/null; then
  echo "These packages are missing, and there is no apt-get to install them with:$why" >&2
  exit 2
fi
root=""
if [ "$(id -u)" != 0 ]; then
  command -v sudo > /dev/null || { echo "Become root, or install these packages:$why" >&2; exit 2; }
  root="sudo"
fi
echo "Installing from the distribution:$why"
export DEBIAN_FRONTEND=noninteractive
if ! $root apt-get install -y -qq --no-install-recommends $missing > /dev/null 2>&1; then
  $root apt-get update -qq
  $root apt-get install -y -qq --no-install-recommends $missing > /dev/null
fi

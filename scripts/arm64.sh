#!/bin/sh
# What a build for arm64 on another machine needs (Debian): the compiler, an emulator, and in build/arm64-system the headers and libraries of an arm64 machine.
set -eu
system=build/arm64-system
sh scripts/setup.sh arm64
[ ! -e "$system/complete" ] || exit 0
. /etc/os-release
mkdir -p build
rm -rf "$system"
root=""
[ "$(id -u)" = 0 ] || root="sudo"
$root mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$(sh scripts/setup.sh libraries)" "$VERSION_CODENAME" "$system" > /dev/null 2>&1 ||
  { echo "$system: the packages of an arm64 machine cannot be had with mmdebstrap" >&2; exit 1; }
$root touch "$system/complete"

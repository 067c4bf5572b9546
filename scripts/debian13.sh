#!/bin/sh
# Runs all tests or the given command on Debian 13, in a system that mmdebstrap makes once in build/debian13-system.
# The working tree is mounted at /breccia of that system and build/debian13 at /breccia/build, so that other builds in
# build/ remain untouched. All mounts and processes belong to private namespaces, which end with the command. A second run
# at the same time is refused, as it would replace libraries and delete temporary files of the first.
#   debian13.sh
#   debian13.sh ctest --preset test -R '^test_deck$'
set -eu
cd "$(dirname "$0")/.."
system=$PWD/build/debian13-system
root=""
[ "$(id -u)" = 0 ] || root="sudo"
sh scripts/setup.sh debian13
if [ ! -e "$system/complete" ]; then
  mkdir -p build
  $root rm -rf "$system"
  log=$(mktemp)
  $root mmdebstrap --quiet --variant=apt --include=make trixie "$system" > "$log" 2>&1 ||
    { cat "$log"; rm -f "$log"; echo "$system: mmdebstrap cannot install Debian 13" >&2; exit 1; }
  rm -f "$log"
  $root mkdir "$system/breccia"
  $root touch "$system/complete"
fi
mkdir -p build/debian13
[ $# -gt 0 ] || set -- make test ALL=1

# In the namespaces, the shell mounts the file systems that programs expect and installs missing packages as root.
# The command itself runs as the calling user.
exec $root unshare --mount --pid --fork --kill-child sh -euc '
  system=$1 user=$2
  shift 2
  exec 9< "$system/complete"
  flock --nonblock 9 || { echo "$system: another run uses this system; wait for its end" >&2; exit 1; }
  mount --bind . "$system/breccia"
  mount --bind build/debian13 "$system/breccia/build"
  mount --rbind /dev "$system/dev"
  mount -t tmpfs -o mode=1777 tmpfs "$system/dev/shm"
  mount -t proc proc "$system/proc"
  mount --rbind /sys "$system/sys"
  cp /etc/hosts /etc/resolv.conf "$system/etc"
  find "$system/tmp" -mindepth 1 -delete
  cd "$system"
  inside="env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp CCACHE_DIR=/breccia/build/ccache"
  $inside chroot . sh /breccia/scripts/setup.sh test
  $inside chroot --userspec="$user" . sh -c '\''cd /breccia && "$@"'\'' sh "$@"
' sh "$system" "$(id -u):$(id -g)" "$@"

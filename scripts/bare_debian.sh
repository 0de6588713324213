#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# A bare Debian or Ubuntu in a folder, to try what a newcomer's machine would do. Needs root and debootstrap.
# usage: bare_debian.sh make SUITE FOLDER        a fresh system with apt and nothing else; replaces FOLDER
#        bare_debian.sh run FOLDER COMMAND...    as root in it, with an empty environment and processes of its own
#        bare_debian.sh certificates FOLDER      installs those in /usr/local/share/ca-certificates in it
#        bare_debian.sh test SUITE FOLDER        makes it, clones the last commit there, runs ./dev demo and ./dev test
#        bare_debian.sh readme SUITE FOLDER      the same, but installs and tries GLIDAR as README.md shows
# The suite, its downloaded packages and its compiler cache are kept in $GLIDAR_BARE_DEBIAN (default: build/bare),
# so that a second run is quick. GLIDAR_MIRROR chooses the mirror of make. test passes on GLIDAR_DATA, read-only.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
kept=${GLIDAR_BARE_DEBIAN:-$root/build/bare}
data=  # folder that is mounted at /data; empty: none

fail() {
  printf 'bare_debian: %s\n' "$*" >&2
  exit 1
}

# A folder is replaced only when an earlier run made it.
remove_tree() {
  [[ -e $1 ]] || return 0
  [[ -f $1/etc/bare_debian ]] || fail "$1 exists and was not made by this script; remove it, or name another folder"
  if grep -q " $(realpath "$1")/" /proc/self/mounts; then fail "something is mounted in $1; unmount it first"; fi
  rm -rf --one-file-system "$1"
}

make_tree() {
  local suite=$1 folder=$2 archive=$kept/$1.tar mirror=()
  command -v debootstrap >/dev/null || fail "debootstrap is missing; apt-get install debootstrap"
  [[ -z ${GLIDAR_MIRROR:-} ]] || mirror=("$GLIDAR_MIRROR")
  remove_tree "$folder"
  mkdir -p "$kept/packages-$suite" "$kept/ccache-$suite" "$folder/etc"
  printf '%s\n' "$suite" >"$folder/etc/bare_debian"
  if [[ ! -f $archive ]]; then
    debootstrap --variant=minbase "$suite" "$folder" "${mirror[@]}" >"$kept/debootstrap-$suite.log" 2>&1 ||
      fail "debootstrap failed; all its output is in $kept/debootstrap-$suite.log"
    tar -C "$folder" --one-file-system --exclude='./var/cache/apt/archives/*.deb' -cf "$archive.part" .
    mv "$archive.part" "$archive"
  else
    tar -C "$folder" -xpf "$archive"
  fi
  cp -L /etc/resolv.conf "$folder/etc/resolv.conf"
  printf 'force-unsafe-io\n' >"$folder/etc/dpkg/dpkg.cfg.d/bare"  # nobody needs it after a power cut
}

# The mounts end with the command, because they belong to its own namespace.
run_in_tree() {
  local folder suite
  folder=$(realpath "$1")
  suite=$(cat "$folder/etc/bare_debian" 2>/dev/null) || fail "$1 was not made by bare_debian.sh make"
  shift
  # shellcheck disable=SC2016 # expanded by the inner shell
  unshare --mount --pid --fork --kill-child bash -c '
    set -euo pipefail
    mount -t proc proc "$1/proc"
    mount -t tmpfs tmpfs "$1/dev/shm"
    mount -t devpts devpts "$1/dev/pts"
    mount --bind "$2" "$1/var/cache/apt/archives"
    mkdir -p "$1/var/cache/apt/archives/partial" "$1/root/.cache/ccache"
    mount --bind "$3" "$1/root/.cache/ccache"
    [[ -z $4 ]] || { mkdir -p "$1/data" && mount --bind -o ro "$4" "$1/data"; }
    exec chroot "$1" env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive ${4:+GLIDAR_DATA=/data} \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${@:5}"' \
    bash "$folder" "$kept/packages-$suite" "$kept/ccache-$suite" "$data" "$@"
}

# What pip needs where a proxy shows certificates of its own.
install_certificates() {
  mkdir -p "$1/usr/local/share/ca-certificates"
  find /usr/local/share/ca-certificates -name '*.crt' -exec cp -t "$1/usr/local/share/ca-certificates" {} +
  run_in_tree "$1" bash -euc '
    apt-get update -q
    apt-get install -q -y --no-install-recommends ca-certificates
    update-ca-certificates
    printf "%s=/etc/ssl/certs/ca-certificates.crt\n" SSL_CERT_FILE PIP_CERT REQUESTS_CA_BUNDLE >>/etc/environment'
}

# clone_tree SUITE FOLDER: a bare system with git and a clone of the last commit.
clone_tree() {
  make_tree "$1" "$2"
  install_certificates "$2"
  run_in_tree "$2" apt-get install -q -y --no-install-recommends git
  git clone --quiet --no-hardlinks "$root" "$2/root/glidar"
}

# Runs shell commands in the clone.
run_in_clone() { run_in_tree "$1" bash -euxo pipefail -c "cd /root/glidar; set -a; . /etc/environment; $2"; }

test_tree() {
  data=${GLIDAR_DATA:-}
  clone_tree "$1" "$2"
  run_in_clone "$2" "./dev demo; ./dev test"
}

# All blocks of README.md in a language.
readme_blocks() { awk -v fence="\`\`\`$1" '/^```/ { shown = $0 == fence; next } shown' "$root/README.md"; }

try_readme() {
  clone_tree "$1" "$2"
  readme_blocks python >"$2/tmp/readme.py"
  run_in_clone "$2" "$(readme_blocks sh)
cd /tmp
glidar-python readme.py
test -s asteroid.pcd"
}

((EUID == 0)) || fail "must be run as root, because it mounts and changes root (sudo $0 $*)"
case ${1:-} in
  make) (($# == 3)) || fail "usage: bare_debian.sh make SUITE FOLDER"; make_tree "$2" "$3" ;;
  run) (($# >= 3)) || fail "usage: bare_debian.sh run FOLDER COMMAND..."; run_in_tree "${@:2}" ;;
  certificates) (($# == 2)) || fail "usage: bare_debian.sh certificates FOLDER"; install_certificates "$2" ;;
  readme) (($# == 3)) || fail "usage: bare_debian.sh readme SUITE FOLDER"; try_readme "$2" "$3" ;;
  test) (($# == 3)) || fail "usage: bare_debian.sh test SUITE FOLDER"; test_tree "$2" "$3" ;;
  *) fail "usage: bare_debian.sh make|readme|test SUITE FOLDER, or bare_debian.sh run FOLDER COMMAND..." ;;
esac

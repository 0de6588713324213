#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages on a bare system in a folder and uses them as an ordinary user would.
# Needs root and debootstrap (see bare_debian.sh).
# usage: try_package.sh PACKAGES [SUITE [FOLDER]]
#   PACKAGES  folder with glidar_*.deb and libglidar-dev_*.deb
#   SUITE     code name of the system, e.g. bookworm (Debian 12); default: that of this machine
#   FOLDER    where the system is made; default: build/try-SUITE; a system of an earlier run is replaced
# Exit status: 0 all checks passed, 1 a check failed, 3 the packages do not install on SUITE.
set -euo pipefail
packages=$(realpath "${1:?the folder of the packages is missing}")
# shellcheck source=/dev/null
suite=${2:-$(. /etc/os-release && printf '%s' "$VERSION_CODENAME")}
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
folder=${3:-$root/build/try-$suite}
bare=$root/scripts/bare_debian.sh
log=$(mktemp)
trap 'rm -f "$log"' EXIT

say() { printf '%s\n' "$*"; }

# check PROMISE COMMAND...: reports the promise; ends the script with the output of the command if it fails.
check() {
  local promise=$1
  shift
  if "$@" >"$log" 2>&1; then
    say "ok: $promise"
  else
    say "FAILED: $promise"
    cat "$log"
    exit 1
  fi
}

as_root() { "$bare" run "$folder" "$@"; }

# A user without rights, in an empty folder.
as_user() { as_root runuser -u tester -- env -C /home/tester HOME=/home/tester "$@"; }

install_packages() {
  check "the lists of packages can be read" as_root apt-get update -q
  if ! as_root apt-get install -q -y "$@" >"$log" 2>&1; then
    say "the packages do not install on $suite:"
    grep -A 30 -E 'unmet dependencies|^E:|Depends:' "$log" || cat "$log"
    say "A package fits the release on which it was built, because releases differ in the versions of"
    say "libraries. Run ./dev package on $suite to get one for it."
    exit 3
  fi
  say "ok: $* installs with $(grep -c '^Setting up' "$log") packages"
}

# Every relative link of the installed documentation points to a file.
links_work() {
  local docs=$folder/usr/share/doc/glidar page target broken=0 count=0
  while IFS= read -r page; do
    while IFS= read -r target; do
      count=$((count + 1))
      [[ -e $(dirname "$page")/$target ]] || { say "$page: $target is missing"; broken=1; }
    done < <(grep -oP '\]\(\K[^)#:\s]+(?=(#[^)]*)?\))' "$page")
  done < <(find "$docs" -name '*.md')
  ((count > 20 && broken == 0))
}

# Neither the search path of libraries nor any text in the programs names a folder of the build.
programs_are_clean() {
  local program
  for program in usr/bin/glidar usr/libexec/glidar/glidar-import; do
    test -f "$folder/$program" || return 1
    if readelf -d "$folder/$program" | grep -E 'R(UN)?PATH'; then return 1; fi
    if grep -aoE "${root}[^[:cntrl:]]*" "$folder/$program"; then return 1; fi
  done
}

campaign_names_what_it_lacks() {
  local status=0 text
  text=$(as_user glidar campaign run x.yaml -o x 2>&1) || status=$?
  say "$text"
  [[ $status == 2 && $text == *"install GLIDAR's Python package"* ]]
}

try_program() {
  local data=/usr/share/glidar
  check "glidar --version prints the version of the package" \
    as_user bash -c "glidar --version | grep -Fw '$(dpkg-deb -f "$packages/${names[0]}" Version)'"
  check "a built-in model becomes a cloud and a picture" \
    as_user bash -c 'glidar render builtin:asteroid -o x.pcd -o x.png && test -s x.pcd -a -s x.png'
  check "a sensor preset is found" \
    as_user bash -c 'glidar render builtin:box --sensor VLP-16 --eye 0,0,0 -o room.pcd && test -s room.pcd'
  check "the installed satellite is read by the helper program, with its textures" \
    as_user bash -c "glidar render $data/models/satellite/satellite.obj -o sat.png && test -s sat.png"
  check "an installed example renders" \
    as_user bash -c 'cd /usr/share/doc/glidar && glidar render examples/two_rocks.yaml -o ~/rocks.png'
  check "OpenGL draws with the recommended drivers" \
    as_user glidar render builtin:sphere --renderer gpu -o sphere.pcd
  check "glidar campaign says which package it lacks" campaign_names_what_it_lacks
  check "every link in the installed documentation works" links_work
  check "the programs name no folder of the build" programs_are_clean
}

try_library() {
  check "a compiler and CMake install" as_root apt-get install -q -y --no-install-recommends g++ cmake make
  cp -r "$root/tests/consumer" "$folder/home/tester/consumer"
  as_root chown -R tester /home/tester/consumer
  check "find_package(glidar) builds a program that measures" as_user bash -c '
    cmake -S consumer -B built && cmake --build built && built/consumer_core && built/consumer'
}

"$bare" make "$suite" "$folder"
mapfile -t names < <(cd "$packages" && ls glidar_*.deb libglidar-dev_*.deb)
((${#names[@]} == 2)) || { say "$packages must hold one glidar_*.deb and one libglidar-dev_*.deb, found: ${names[*]}"; exit 1; }
cp "${names[@]/#/$packages/}" "$folder/tmp/"
as_root useradd --create-home tester
install_packages "/tmp/${names[0]}"
try_program
install_packages "/tmp/${names[1]}"
try_library
check "the packages can be removed" as_root apt-get remove -q -y glidar libglidar-dev
check "nothing of them is left" bash -c "! find '$folder/usr' -name '*glidar*' | grep ."

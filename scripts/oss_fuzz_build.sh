#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzzers the way OSS-Fuzz does (https://google.github.io/oss-fuzz): it sets CXX, CXXFLAGS,
# LIB_FUZZING_ENGINE, WORK and OUT; the fuzzers with their corpora and dictionaries come into OUT.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
: "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
: "${CXXFLAGS:=-O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer}"
: "${WORK:=build/oss-fuzz}" "${OUT:=build/oss-fuzz/out}"
export CXX CXXFLAGS LIB_FUZZING_ENGINE

mkdir -p "$WORK" "$OUT"
OUT=$(realpath "$OUT")
cmake -S . -B "$WORK" -G Ninja -DGLIDAR_BUILD_FUZZERS=ON -DGLIDAR_BUILD_VIEWER=OFF -DGLIDAR_HARDENING=OFF
targets=()
for corpus in tests/fuzz/corpus/*/; do targets+=("glidar_fuzz_$(basename "$corpus")"); done
ninja -C "$WORK" glidar_import "${targets[@]}"
for target in "${targets[@]}"; do
  name=${target#glidar_fuzz_}
  cp "$WORK/tests/fuzz/$target" "$OUT/"
  (cd "tests/fuzz/corpus/$name" && python3 -m zipfile -c "$OUT/${target}_seed_corpus.zip" ./*)
  if [[ -f tests/fuzz/dictionaries/$name.dict ]]; then cp "tests/fuzz/dictionaries/$name.dict" "$OUT/$target.dict"; fi
done

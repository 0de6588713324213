// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// One program for each reader of files: GLIDAR_FUZZ_DECODER is its name.
#include "file_decoders.hpp"
#include "input_cost.hpp"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const glidar::testing::InputCost cost(size);
  static const auto& decoder = glidar::testing::file_decoder(GLIDAR_FUZZ_DECODER);
  glidar::testing::try_file_decoder(decoder, std::as_bytes(std::span(data, size)));
  return 0;
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "input_cost.hpp"
#include "lockstep_decoders.hpp"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const glidar::testing::InputCost cost(size);
  glidar::testing::try_lockstep_decoders(std::as_bytes(std::span(data, size)));
  return 0;
}

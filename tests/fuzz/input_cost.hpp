// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace glidar::testing {

/// Lives while one input is read. At its end the program ends, so that a fuzzer reports the input,
/// if reading took more than 5 s of the processor and 1 ms for each byte, or had more than 512 MiB
/// and 4 KiB for each byte allocated at once. Memory is measured with the address sanitizer.
class InputCost {
 public:
  explicit InputCost(std::size_t input_bytes);
  InputCost(const InputCost&) = delete;
  InputCost& operator=(const InputCost&) = delete;
  ~InputCost();

 private:
  std::size_t input_bytes_;
  double start_s_;
};

}  // namespace glidar::testing

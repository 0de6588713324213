// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar::import {

struct ProcessLimits {
  std::uint64_t memory_bytes = 0;  ///< address space, and size of any file written
  double time_s = 0.0;             ///< of the processor; the parent watches the wall clock
  std::int64_t parent = 0;         ///< process id; this process ends with it
};

/// Applies the limits to this process permanently: no core dumps, no new privileges, killed when
/// the parent dies. False if one of them fails.
bool apply(const ProcessLimits& limits);

/// Limits of memory, stack and processor time in proportion to the size of an input, for libraries
/// that count nothing themselves. Memory beyond them cannot be allocated; time beyond them ends the
/// process with SIGPROF. The end of this object restores the limits of the process.
class InputLimits {
 public:
  InputLimits();
  ~InputLimits();
  InputLimits(const InputLimits&) = delete;
  InputLimits& operator=(const InputLimits&) = delete;

  /// The size of all files of the input that are open.
  void set_input(std::uint64_t bytes);
  [[nodiscard]] std::uint64_t memory_bytes() const;
  /// Whether its limit of memory is lower than that of the process.
  [[nodiscard]] bool is_strictest() const;

 private:
  void apply() const;

  std::uint64_t input_bytes_ = 0;  ///< at most 1 TiB
  double start_s_ = 0.0;           ///< processor time
};

}  // namespace glidar::import

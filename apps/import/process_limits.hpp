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

}  // namespace glidar::import

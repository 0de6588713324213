// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

/// Bits per axis of a Morton code.
inline constexpr unsigned kMortonBits = 16;

/// Inserts two zeros before each of the low 16 bits: one axis of a code along G. M. Morton's curve
/// ("A computer oriented geodetic data base", 1966).
inline std::uint64_t expand_bits(std::uint64_t bits) {
  std::uint64_t result = 0;
  for (unsigned i = 0; i < kMortonBits; ++i) result |= (bits >> i & 1U) << (3 * i);
  return result;
}

}  // namespace glidar

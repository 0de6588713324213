// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

/// Counter of Philox4x32, and its result after the rounds.
struct PhiloxState {
  std::uint32_t c0;
  std::uint32_t c1;
  std::uint32_t c2;
  std::uint32_t c3;
};

/// The ten rounds, unrolled, so that loops over counters vectorise. Multipliers and Weyl
/// increments: SC'11 paper (see random.hpp), table 2; Random123 philox.h.
[[gnu::always_inline]] inline void philox_rounds(PhiloxState& s, std::uint32_t k0,
                                                 std::uint32_t k1) {
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53U;
  constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57U;
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9U;
  constexpr std::uint32_t kWeyl1 = 0xBB67AE85U;
  constexpr int kRounds = 10;
#pragma GCC unroll 10
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t p0 = kMultiplier0 * s.c0;
    const std::uint64_t p1 = kMultiplier1 * s.c2;
    s = {static_cast<std::uint32_t>(p1 >> 32U) ^ s.c1 ^ k0, static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32U) ^ s.c3 ^ k1, static_cast<std::uint32_t>(p0)};
    k0 += kWeyl0;
    k1 += kWeyl1;
  }
}

}  // namespace glidar

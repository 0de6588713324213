// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/random.hpp>

namespace glidar {
namespace {

// Multipliers and Weyl increments of Philox4x32 (SC'11 paper, table 2; Random123 philox.h).
constexpr std::uint64_t kMultiplier0 = 0xD2511F53U;
constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57U;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9U;
constexpr std::uint32_t kWeyl1 = 0xBB67AE85U;
constexpr int kRounds = 10;

}  // namespace

RandomWords philox4x32(RandomWords counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t p0 = kMultiplier0 * counter[0];
    const std::uint64_t p1 = kMultiplier1 * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32U) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32U) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(p0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

RandomWords random_words(const Draw& draw) {
  const auto purpose = static_cast<std::uint32_t>(draw.purpose) << 24U;
  return philox4x32({draw.beam, purpose, draw.frame, draw.block},
                    {static_cast<std::uint32_t>(draw.seed),
                     static_cast<std::uint32_t>(draw.seed >> 32U) ^ draw.sensor});
}

double uniform(std::uint32_t word) {
  constexpr double kStep = 1.0 / 4294967296.0;
  return (static_cast<double>(word) + 0.5) * kStep;
}

}  // namespace glidar

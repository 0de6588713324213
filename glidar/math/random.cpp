// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/random.hpp>

#include <cassert>

namespace glidar {

RandomWords philox4x32(RandomWords counter, std::array<std::uint32_t, 2> key) {
  PhiloxState state{counter[0], counter[1], counter[2], counter[3]};
  philox_rounds(state, key[0], key[1]);
  return {state.c0, state.c1, state.c2, state.c3};
}

RandomWords counter_of(const RngKey& key) {
  constexpr std::uint32_t kBlockBits = 24;
  assert(key.block >> kBlockBits == 0);
  const auto purpose = static_cast<std::uint32_t>(key.purpose) << kBlockBits;
  return {key.beam, purpose | key.block, key.frame, key.sensor};
}

std::array<std::uint32_t, 2> key_of(const RngKey& key) {
  return {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32U)};
}

RandomWords random_words(const RngKey& key) {
  return philox4x32(counter_of(key), key_of(key));
}

double uniform(std::uint32_t word) {
  constexpr double kStep = 1.0 / 4294967296.0;
  return (static_cast<double>(word) + 0.5) * kStep;
}

}  // namespace glidar

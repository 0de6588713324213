// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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

using RandomWords = std::array<std::uint32_t, 4>;

/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3",
/// SC'11): four random words that are a pure function of counter and key.
RandomWords philox4x32(RandomWords counter, std::array<std::uint32_t, 2> key);

/// The purpose of a random number is part of its counter, so that purposes never share numbers.
enum class Purpose : std::uint8_t {
  verification = 0,
  detection = 1,
  weather = 3,
  fog = 4,
  dot_pattern = 5,
  left_image = 6,
  right_image = 7,
  imu_constants = 8,
  imu_noise = 9,
  imu_correlated_bias = 10,
  imu_random_walk = 11,
  tof_exposure = 12,
  tof_bounces = 13,
  radial_velocity = 14,
  pattern_image = 15,
  first_noise_step = 32,  ///< noise step k of a sensor, from 0, uses first_noise_step + k
};

/// Identifies four random words: equal keys give equal words on any machine, with any number of
/// threads.
struct RngKey {
  std::uint64_t seed = 0;
  std::uint32_t sensor = 0;
  std::uint32_t frame = 0;
  std::uint32_t beam = 0;
  Purpose purpose = Purpose::verification;
  std::uint32_t block = 0;  ///< blocks of four words of a beam and purpose, below 2^24
};

/// (beam, purpose << 24 | block, frame, sensor): with the seed, each part has bits of its own.
RandomWords counter_of(const RngKey& key);

/// (low word of seed, high word). Philox is a bijection for each key, so no numbers are repeated.
std::array<std::uint32_t, 2> key_of(const RngKey& key);

/// RngKey::frame of random numbers that are the same for all frames of a sensor.
inline constexpr std::uint32_t kAllFrames = 0xFFFFFFFFU;

/// philox4x32(counter_of(key), key_of(key)).
RandomWords random_words(const RngKey& key);

/// A word as a double strictly between 0 and 1: (word + 0.5) / 2^32, exact.
double uniform(std::uint32_t word);

}  // namespace glidar

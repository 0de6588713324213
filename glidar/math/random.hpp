// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace glidar {

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

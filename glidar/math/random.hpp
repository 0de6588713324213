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

/// What a random number is for; part of its counter, so that purposes never share numbers.
enum class Purpose : std::uint8_t {
  verification = 0,
  detection = 1,
  weather = 3,
  fog = 4,
  first_noise_step = 32,  ///< step k of a sensor's list of noise draws with first_noise_step + k
};

/// Identifies one draw: same identity, same numbers, on any machine and any number of threads.
struct RngKey {
  std::uint64_t seed = 0;
  std::uint32_t sensor = 0;
  std::uint32_t frame = 0;
  std::uint32_t beam = 0;
  Purpose purpose = Purpose::verification;
  std::uint32_t block = 0;  ///< successive blocks of four words of the same draw
};

/// The counter of a draw: (beam, purpose << 24, frame, block).
RandomWords counter_of(const RngKey& draw);

/// The key of a draw: (seed low, seed high xor sensor).
std::array<std::uint32_t, 2> key_of(const RngKey& draw);

/// The frame of draws that stay the same for all frames of a sensor.
inline constexpr std::uint32_t kAllFrames = 0xFFFFFFFFU;

/// The four words of a draw: philox4x32 of its counter and key.
RandomWords random_words(const RngKey& draw);

/// A word as a double strictly between 0 and 1: (x + 0.5) / 2^32, exact.
double uniform(std::uint32_t word);

}  // namespace glidar

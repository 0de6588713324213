// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/random.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace glidar {
namespace {

TEST(Philox, ReproducesTheKnownAnswersOfRandom123) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (RandomWords{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (RandomWords{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (RandomWords{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomWords, DependOnBeamFrameAndBlock) {
  const auto at = [](std::uint32_t beam) {
    return random_words({.seed = 12345, .sensor = 0, .frame = 7, .beam = beam});
  };
  EXPECT_EQ(at(0), (RandomWords{0xe6f940bb, 0x8f703033, 0x680c7f25, 0x5e9ad4d4}));
  EXPECT_EQ(at(1), (RandomWords{0xa1b975c9, 0xae052b7e, 0xef9fd9d3, 0x35f25bb1}));
  EXPECT_EQ(at(1000), (RandomWords{0xe985ae61, 0x83621db8, 0x229a865d, 0xeb52ccdb}));
}

TEST(RandomWords, DifferForEveryPartOfTheKey) {
  const RngKey draw{.seed = 1, .sensor = 2, .frame = 3, .beam = 4, .block = 5};
  for (const auto part : {&RngKey::sensor, &RngKey::frame, &RngKey::beam, &RngKey::block}) {
    RngKey other = draw;
    other.*part += 1;
    EXPECT_NE(random_words(draw), random_words(other));
  }
  RngKey other = draw;
  other.seed += std::uint64_t{1} << 32U;
  EXPECT_NE(random_words(draw), random_words(other));
}

TEST(RandomWords, OfASensorAreNotThoseOfAnotherSeed) {
  constexpr std::uint64_t kHighWord = std::uint64_t{1} << 32U;
  for (std::uint32_t sensor = 1; sensor < 100; ++sensor) {
    EXPECT_NE(random_words({.seed = 5 + kHighWord * sensor}),
              random_words({.seed = 5, .sensor = sensor}));
  }
}

/// Counter and key of numbers of which each is at its bounds or has a few bits.
using Input = std::pair<RandomWords, std::array<std::uint32_t, 2>>;

TEST(RandomWords, HaveACounterAndKeyOfTheirOwnForEveryPartOfTheRngKey) {
  const std::vector<std::uint32_t> words = {0, 1, 5, 1U << 23U, 1U << 31U, 0xFFFFFFFFU};
  const std::vector<std::uint32_t> purposes = {0, 1, 5, 255};
  const std::vector<std::uint32_t> blocks = {0, 1, 5, (1U << 24U) - 1U};
  constexpr std::size_t kCount = 6 * 6 * 6 * 6 * 4 * 4;
  std::set<Input> inputs;
  for (std::size_t i = 0; i < kCount; ++i) {
    std::size_t rest = i;
    const auto pick = [&](const std::vector<std::uint32_t>& from) {
      const std::uint32_t value = from[rest % from.size()];
      rest /= from.size();
      return value;
    };
    const RngKey key{.seed = std::uint64_t{pick(words)} << 32U | 5U,
                     .sensor = pick(words),
                     .frame = pick(words),
                     .beam = pick(words),
                     .purpose = static_cast<Purpose>(pick(purposes)),
                     .block = pick(blocks)};
    inputs.emplace(counter_of(key), key_of(key));
  }
  EXPECT_EQ(inputs.size(), kCount);
}

TEST(RandomWords, OfManySeedsSensorsAndPurposesAreDifferentAndIndependent) {
  constexpr std::uint32_t kCount = 40 * 40 * 40;
  std::set<RandomWords> found;
  double sum = 0.0;
  double products = 0.0;
  double before = 0.0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const RandomWords words = random_words(
        {.seed = i / 1600, .sensor = i / 40 % 40, .purpose = static_cast<Purpose>(i % 40)});
    found.insert(words);
    const double number = uniform(words[0]) - 0.5;
    sum += number;
    products += number * before;
    before = number;
  }
  EXPECT_EQ(found.size(), kCount);
  const double root = std::sqrt(static_cast<double>(kCount));
  EXPECT_LT(std::abs(sum), 4.0 * root / std::sqrt(12.0));
  EXPECT_LT(std::abs(products), 4.0 * root / 12.0);
}

TEST(Uniform, IsStrictlyBetweenZeroAndOneAndExact) {
  EXPECT_EQ(uniform(0), 0.5 / 4294967296.0);
  EXPECT_EQ(uniform(0xffffffff), 1.0 - 0.5 / 4294967296.0);
}

}  // namespace
}  // namespace glidar

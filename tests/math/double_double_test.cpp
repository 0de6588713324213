// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/double_double.hpp>
#include <glidar/math/random.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

/// Whole numbers of up to 62 bits as high + low, whose sums are exact in 64 bits.
DoubleDouble number(std::int64_t value) {
  const double high = std::floor(static_cast<double>(value) * 0x1p-20) * 0x1p20;
  return exact_sum(high, static_cast<double>(value - static_cast<std::int64_t>(high)));
}

std::int64_t whole(const DoubleDouble& value) {
  return static_cast<std::int64_t>(value.high) + static_cast<std::int64_t>(value.low);
}

std::int64_t random_whole(std::uint32_t index, unsigned bits) {
  const RandomWords words = random_words({.seed = 11, .beam = index});
  const std::uint64_t value = std::uint64_t{words[0]} << 32U | words[1];
  const auto size = static_cast<std::int64_t>(value >> (64U - bits));
  return words[2] % 2 == 0 ? size : -size;
}

constexpr std::uint32_t kNumbers = 20000;

TEST(DoubleDouble, SumsOf61BitsAreExact) {
  for (std::uint32_t i = 0; i < kNumbers; ++i) {
    const std::int64_t a = random_whole(2 * i, 61);
    const std::int64_t b = random_whole(2 * i + 1, 61);
    EXPECT_EQ(whole(number(a) + number(b)), a + b);
    EXPECT_EQ(whole(number(a) - number(b)), a - b);
    EXPECT_EQ(number(a) < number(b), a < b);
    EXPECT_EQ(whole(abs(number(a))), std::abs(a));
  }
}

TEST(DoubleDouble, ProductsAndTheirQuotientsAndRootsAreExact) {
  for (std::uint32_t i = 0; i < kNumbers; ++i) {
    const std::int64_t a = random_whole(2 * i, 31);
    const std::int64_t b = random_whole(2 * i + 1, 31) | 1;
    const DoubleDouble product = number(a) * number(b);
    EXPECT_EQ(whole(product), a * b);
    EXPECT_EQ(whole(product / number(b)), a);
    EXPECT_EQ(whole(sqrt(number(a) * number(a))), std::abs(a));
  }
}

TEST(DoubleDouble, QuotientsAndRootsHave102Bits) {
  for (std::uint32_t i = 1; i < kNumbers; ++i) {
    const DoubleDouble a = number(std::abs(random_whole(2 * i, 61)) + 1);
    const DoubleDouble b = number(random_whole(2 * i + 1, 61) | 1);
    EXPECT_LT(std::abs(((a / b) * b - a).high), 0x1p-102 * a.high);
    EXPECT_LT(std::abs((sqrt(a) * sqrt(a) - a).high), 0x1p-102 * a.high);
  }
  EXPECT_EQ(sqrt(DoubleDouble(0.0)), DoubleDouble(0.0));
}

TEST(DoubleDouble, ConversionRoundsToTheNearestDouble) {
  EXPECT_EQ(static_cast<double>(DoubleDouble(1.0) + 0x1p-54), 1.0);
  EXPECT_EQ(static_cast<double>(DoubleDouble(1.0) + 0x1.8p-53), 1.0 + 0x1p-52);
}

}  // namespace
}  // namespace glidar

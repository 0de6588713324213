// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/distributions.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/random.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// uniform() by bits, for loops that vectorise.
inline double uniform_of(std::uint32_t word) {
  return (whole_to_double(word) + 0.5) * 0x1p-32;
}

/// The radius of Box and Muller's method.
inline double radius(std::uint32_t word) {
  return std::sqrt(-2.0 * portable_log(uniform_of(word)));
}

GLIDAR_SIMD void fill_words(const RandomWords& counter, const std::array<std::uint32_t, 2>& key,
                            WordBatch& words) {
  for (std::uint32_t i = 0; i < kSampleBatch; ++i) {
    PhiloxState state{counter[0] + i, counter[1], counter[2], counter[3]};
    philox_rounds(state, key[0], key[1]);
    words.word[0][i] = state.c0;
    words.word[1][i] = state.c1;
    words.word[2][i] = state.c2;
    words.word[3][i] = state.c3;
  }
}

GLIDAR_SIMD void fill_first(const WordBatch& words, Batch<double>& out) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    out[i] = radius(words.word[0][i]) * sincos_turns(uniform_of(words.word[1][i])).cosine;
  }
}

GLIDAR_SIMD void fill_pairs(const Batch<std::uint32_t>& a, const Batch<std::uint32_t>& b,
                            PairBatch& out) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double r = radius(a[i]);
    const SineCosine angle = sincos_turns(uniform_of(b[i]));
    out.first[i] = r * angle.cosine;
    out.second[i] = r * angle.sine;
  }
}

constexpr std::size_t kQuarter = kSampleBatch / 4;

/// Word 0 of 64 counters, then their word 1, and so on.
GLIDAR_SIMD void fill_shared_words(const RandomWords& counter,
                                   const std::array<std::uint32_t, 2>& key,
                                   Batch<std::uint32_t>& words) {
  for (std::uint32_t i = 0; i < kQuarter; ++i) {
    PhiloxState state{counter[0] + i, counter[1], counter[2], counter[3]};
    philox_rounds(state, key[0], key[1]);
    words[i] = state.c0;
    words[kQuarter + i] = state.c1;
    words[2 * kQuarter + i] = state.c2;
    words[3 * kQuarter + i] = state.c3;
  }
}

/// Normals from the first two quarters of the words (half 0) or the last two (half 1).
GLIDAR_SIMD void fill_shared_normals(std::size_t half, const Batch<std::uint32_t>& words,
                                     Batch<double>& out) {
  const std::size_t first = half * 2 * kQuarter;
  for (std::size_t i = first; i < first + kQuarter; ++i) {
    const double r = radius(words[i]);
    const SineCosine angle = sincos_turns(uniform_of(words[kQuarter + i]));
    out[i] = r * angle.cosine;
    out[kQuarter + i] = r * angle.sine;
  }
}

GLIDAR_SIMD void fill_uniform(const Batch<std::uint32_t>& words, Batch<double>& out) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) out[i] = uniform_of(words[i]);
}

void sample_shared_words(RngKey first, Batch<std::uint32_t>& words) {
  first.beam /= 4;
  fill_shared_words(counter_of(first), key_of(first), words);
}

GLIDAR_SIMD void fill_uniforms(const WordBatch& words, PairBatch& out) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    out.first[i] = uniform_of(words.word[0][i]);
    out.second[i] = uniform_of(words.word[1][i]);
  }
}

}  // namespace

std::array<double, 4> normals(const RandomWords& words) {
  const double r0 = radius(words[0]);
  const double r1 = radius(words[2]);
  const SineCosine angle0 = sincos_turns(uniform_of(words[1]));
  const SineCosine angle1 = sincos_turns(uniform_of(words[3]));
  return {r0 * angle0.cosine, r0 * angle0.sine, r1 * angle1.cosine, r1 * angle1.sine};
}

void box_muller(const WordBatch& words, std::size_t pair, PairBatch& normals) {
  fill_pairs(words.word.at(2 * pair), words.word.at(2 * pair + 1), normals);
}

void sample_words(const RngKey& first, WordBatch& words) {
  fill_words(counter_of(first), key_of(first), words);
}

void sample_normals(const RngKey& first, Batch<double>& normals) {
  WordBatch words;
  sample_words(first, words);
  fill_first(words, normals);
}

void sample_normals(const RngKey& first, PairBatch& normals) {
  WordBatch words;
  sample_words(first, words);
  box_muller(words, 0, normals);
}

void sample_shared_normals(const RngKey& first, Batch<double>& normals) {
  alignas(64) Batch<std::uint32_t> words;
  sample_shared_words(first, words);
  fill_shared_normals(0, words, normals);
  fill_shared_normals(1, words, normals);
}

void sample_shared_uniforms(const RngKey& first, Batch<double>& uniforms) {
  alignas(64) Batch<std::uint32_t> words;
  sample_shared_words(first, words);
  fill_uniform(words, uniforms);
}

void sample_uniforms(const RngKey& first, PairBatch& uniforms) {
  WordBatch words;
  sample_words(first, words);
  fill_uniforms(words, uniforms);
}

double sample_gamma(double deviation, RngKey key) {
  if (deviation == 0.0) return 1.0;
  const double shape = 1.0 / (deviation * deviation);  // at least 1
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (;; ++key.block) {  // 95 % or more of the attempts succeed
    const RandomWords words = random_words(key);
    const double x = normals(words)[0];
    const double root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double limit = 0.5 * x * x + d - d * v + d * portable_log(v);
    if (portable_log(uniform(words[2])) < limit) return d * v / shape;
  }
}

namespace {

double invert_poisson(double mean, double uniform) {
  double probability = portable_exp(-mean);
  double sum = probability;
  double number = 0.0;
  // The terms vanish long before the limit, which only ends sums that rounding keeps below u.
  constexpr double kMaxNumber = 200.0;
  while (sum < uniform && number < kMaxNumber) {
    number += 1.0;
    probability *= mean / number;
    sum += probability;
  }
  return number;
}

}  // namespace

double sample_poisson(double mean, double uniform, double normal) {
  if (mean < kPoissonInversionLimit) return invert_poisson(mean, uniform);
  const double root = std::sqrt(mean - 1.0 / 12.0);
  const double square = normal * normal;
  const double number =
      mean + root * normal + (square - 1.0) / 6.0 + normal * (1.0 - square) / (72.0 * root);
  return std::max(0.0, std::floor(number + 0.5));
}

}  // namespace glidar

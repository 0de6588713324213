// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/gaussian.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/philox.hpp>
#include <glidar/math/simd.hpp>

#include <cmath>

namespace glidar {
namespace {

/// uniform() by bits, for loops that become vectors.
inline double uniform_of(std::uint32_t word) {
  return (double_of(word) + 0.5) * 0x1p-32;
}

/// The radius of Box and Muller.
inline double radius(std::uint32_t word) {
  return std::sqrt(-2.0 * natural_log(uniform_of(word)));
}

GLIDAR_SIMD void fill_words(const RandomWords& counter, const std::array<std::uint32_t, 2>& key,
                            WordBatch& words) {
  for (std::uint32_t i = 0; i < kDrawBatch; ++i) {
    PhiloxState state{counter[0] + i, counter[1], counter[2], counter[3]};
    philox_rounds(state, key[0], key[1]);
    words.word[0][i] = state.c0;
    words.word[1][i] = state.c1;
    words.word[2][i] = state.c2;
    words.word[3][i] = state.c3;
  }
}

GLIDAR_SIMD void fill_first(const WordBatch& words, Batch<double>& out) {
  for (std::size_t i = 0; i < kDrawBatch; ++i) {
    out[i] = radius(words.word[0][i]) * of_turns(uniform_of(words.word[1][i])).cosine;
  }
}

GLIDAR_SIMD void fill_pairs(const Batch<std::uint32_t>& a, const Batch<std::uint32_t>& b,
                            PairBatch& out) {
  for (std::size_t i = 0; i < kDrawBatch; ++i) {
    const double r = radius(a[i]);
    const SineCosine angle = of_turns(uniform_of(b[i]));
    out.first[i] = r * angle.cosine;
    out.second[i] = r * angle.sine;
  }
}

constexpr std::size_t kQuarter = kDrawBatch / 4;

/// The first words of 64 draws, then their second words, and so on.
GLIDAR_SIMD void fill_quarters(const RandomWords& counter, const std::array<std::uint32_t, 2>& key,
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

/// Normals from the first half of the run's quarters, or from the second.
GLIDAR_SIMD void fill_half(std::size_t half, const Batch<std::uint32_t>& words,
                           Batch<double>& out) {
  const std::size_t first = half * 2 * kQuarter;
  for (std::size_t i = first; i < first + kQuarter; ++i) {
    const double r = radius(words[i]);
    const SineCosine angle = of_turns(uniform_of(words[kQuarter + i]));
    out[i] = r * angle.cosine;
    out[kQuarter + i] = r * angle.sine;
  }
}

GLIDAR_SIMD void fill_uniform(const Batch<std::uint32_t>& words, Batch<double>& out) {
  for (std::size_t i = 0; i < kDrawBatch; ++i) out[i] = uniform_of(words[i]);
}

void draw_quarters(RngKey first, Batch<std::uint32_t>& words) {
  first.beam /= 4;
  fill_quarters(counter_of(first), key_of(first), words);
}

GLIDAR_SIMD void fill_uniforms(const WordBatch& words, PairBatch& out) {
  for (std::size_t i = 0; i < kDrawBatch; ++i) {
    out.first[i] = uniform_of(words.word[0][i]);
    out.second[i] = uniform_of(words.word[1][i]);
  }
}

}  // namespace

std::array<double, 4> normals(const RandomWords& words) {
  const double r0 = radius(words[0]);
  const double r1 = radius(words[2]);
  const SineCosine angle0 = of_turns(uniform_of(words[1]));
  const SineCosine angle1 = of_turns(uniform_of(words[3]));
  return {r0 * angle0.cosine, r0 * angle0.sine, r1 * angle1.cosine, r1 * angle1.sine};
}

void make_normals(const WordBatch& words, std::size_t pair, PairBatch& normals) {
  fill_pairs(words.word.at(2 * pair), words.word.at(2 * pair + 1), normals);
}

void draw_words(const RngKey& first, WordBatch& words) {
  fill_words(counter_of(first), key_of(first), words);
}

void draw_normals(const RngKey& first, Batch<double>& normals) {
  WordBatch words;
  draw_words(first, words);
  fill_first(words, normals);
}

void draw_normals(const RngKey& first, PairBatch& normals) {
  WordBatch words;
  draw_words(first, words);
  make_normals(words, 0, normals);
}

void draw_shared_normals(const RngKey& first, Batch<double>& normals) {
  alignas(64) Batch<std::uint32_t> words;
  draw_quarters(first, words);
  fill_half(0, words, normals);
  fill_half(1, words, normals);
}

void draw_shared_uniforms(const RngKey& first, Batch<double>& uniforms) {
  alignas(64) Batch<std::uint32_t> words;
  draw_quarters(first, words);
  fill_uniform(words, uniforms);
}

void draw_uniforms(const RngKey& first, PairBatch& uniforms) {
  WordBatch words;
  draw_words(first, words);
  fill_uniforms(words, uniforms);
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/random.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glidar {

/// Box and Muller, "A note on the generation of random normal deviates", Ann. Math. Stat. 29
/// (1958): from words a, b the normals sqrt(-2 ln u_a) cos(2 pi u_b) and the same with the sine.
/// The first two words of four give the first two normals. Equal bytes on any machine.
std::array<double, 4> normals(const RandomWords& words);

/// So many beams are drawn for at once.
inline constexpr std::size_t kDrawBatch = 256;

template <class T>
using Batch = std::array<T, kDrawBatch>;

/// The words of a run of beams, the first of each beam in word[0] and so on.
struct alignas(64) WordBatch {
  std::array<Batch<std::uint32_t>, 4> word;
};

/// Two numbers a beam.
struct alignas(64) PairBatch {
  Batch<double> first;
  Batch<double> second;
};

/// Normals 2 pair and 2 pair + 1 of normals() of each beam's words.
void make_normals(const WordBatch& words, std::size_t pair, PairBatch& normals);

/// The words of beams first.beam, first.beam + 1, ...; the same as random_words gives one by one.
void draw_words(const RngKey& first, WordBatch& words);

/// The first normal of each beam; the same as normals() gives one by one.
void draw_normals(const RngKey& first, Batch<double>& normals);

/// The first two normals of each beam.
void draw_normals(const RngKey& first, PairBatch& normals);

// One number a beam, for runs that start at multiples of kDrawBatch: four beams share the words of
// one draw, which takes a third of the time. Beam b of a run, from 0, has number b / 64 of the
// words of beam first.beam / 4 + b % 64.

/// Standard normal numbers, of normals() of the words.
void draw_shared_normals(const RngKey& first, Batch<double>& normals);

/// Uniform numbers, strictly between 0 and 1, one of each word.
void draw_shared_uniforms(const RngKey& first, Batch<double>& uniforms);

/// Uniform numbers, strictly between 0 and 1, from words 0 and 1 of each beam.
void draw_uniforms(const RngKey& first, PairBatch& uniforms);

}  // namespace glidar

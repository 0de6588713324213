// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/random.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glidar {

/// Standard normal numbers by Box and Muller, "A note on the generation of random normal deviates",
/// Ann. Math. Stat. 29 (1958): words a, b give sqrt(-2 ln u_a) cos(2 pi u_b) and the same with the
/// sine. Words 0, 1 give normals 0, 1; words 2, 3 give normals 2, 3. Bit-identical on any machine.
std::array<double, 4> normals(const RandomWords& words);

/// Number of beams that the functions below sample at once.
inline constexpr std::size_t kSampleBatch = 256;

template <class T>
using Batch = std::array<T, kSampleBatch>;

/// Random words of consecutive beams: word[k][i] is word k of beam i.
struct alignas(64) WordBatch {
  std::array<Batch<std::uint32_t>, 4> word;
};

/// Two numbers per beam.
struct alignas(64) PairBatch {
  Batch<double> first;
  Batch<double> second;
};

/// Normals 2 `pair` and 2 `pair` + 1 of each beam, bit-identical to normals(); `pair` is 0 or 1.
void box_muller(const WordBatch& words, std::size_t pair, PairBatch& normals);

/// The words of beams first.beam, first.beam + 1, ..., identical to random_words() of each beam.
void sample_words(const RngKey& first, WordBatch& words);

/// The first normal of each beam, bit-identical to normals()[0].
void sample_normals(const RngKey& first, Batch<double>& normals);

/// The first two normals of each beam, bit-identical to normals().
void sample_normals(const RngKey& first, PairBatch& normals);

// One number per beam, for batches that start at multiples of kSampleBatch. Four beams share the
// words of one Philox call, which takes a third of the time: beam b of a batch, from 0, has word
// b / 64 of beam first.beam / 4 + b % 64.

/// Standard normal numbers: normals() of the shared words.
void sample_shared_normals(const RngKey& first, Batch<double>& normals);

/// Uniform numbers strictly between 0 and 1: uniform() of the shared words.
void sample_shared_uniforms(const RngKey& first, Batch<double>& uniforms);

/// Uniform numbers strictly between 0 and 1, from words 0 and 1 of each beam.
void sample_uniforms(const RngKey& first, PairBatch& uniforms);

/// A number of the gamma distribution of mean 1 and a standard deviation from 0 to 1 (Marsaglia and
/// Tsang, A simple method for generating gamma variables, ACM TOMS 26(3), 2000). Uses the blocks of
/// `key` from its block on.
double sample_gamma(double deviation, RngKey key);

/// Means below it use the uniform number, others the normal one.
inline constexpr double kPoissonInversionLimit = 32.0;

/// A Poisson number of a mean from 0, as a function of one uniform number in (0, 1) or one standard
/// normal number. Below kPoissonInversionLimit it inverts the distribution, exactly to the
/// resolution of the uniform number. Above it is the rounded Cornish-Fisher expansion of the
/// quantile to the third order (Abramowitz and Stegun 26.2.49), of the variance less 1/12, which
/// rounding adds; mean and variance are within 1e-3 of the exact ones, relative to the mean.
double sample_poisson(double mean, double uniform, double normal);

}  // namespace glidar

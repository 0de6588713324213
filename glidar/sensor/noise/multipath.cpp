// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/multipath.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// Consecutive pixels of a row and one more at each end.
using Strip = std::array<double, kSampleBatch + 2>;

/// Ranges and amplitudes of the pixels of a row; amplitude 0: no return.
struct alignas(64) Echoes {
  Strip range_m;
  Strip amplitude;
};

/// Of three rows, the middle one and the sum of the other two.
struct alignas(64) Rows {
  Strip middle;
  Strip outer;
};

/// Loads the pixels [col - 1, col + count + 1) of a row, which may be outside the image.
void load_echoes(const NoiseView& view, std::ptrdiff_t row, std::ptrdiff_t col, std::size_t count,
                 Echoes& echoes) {
  const NoiseWorkspace& kept = view.workspace;
  const auto cols = static_cast<std::ptrdiff_t>(view.beams.cols);
  const bool is_inside = row >= 0 && row < static_cast<std::ptrdiff_t>(view.beams.rows);
  for (std::size_t k = 0; k < count + 2; ++k) {
    const std::ptrdiff_t c = col - 1 + static_cast<std::ptrdiff_t>(k);
    const auto at = static_cast<std::size_t>(row * cols + c);
    const bool has_return = is_inside && c >= 0 && c < cols && !std::isnan(kept.before[at]);
    echoes.range_m[k] = has_return ? kept.before[at] : 0.0;
    echoes.amplitude[k] = has_return ? double{kept.amplitude[at]} : 0.0;
  }
}

/// The phasors of a row: amplitude times cosine and sine of the phase.
GLIDAR_SIMD void make_phasors(const Echoes& echoes, double per_m, std::size_t count, Strip& real,
                              Strip& imaginary) {
  for (std::size_t k = 0; k < count; ++k) {
    const SineCosine wave = sincos_turns(echoes.range_m[k] * per_m);
    real[k] = echoes.amplitude[k] * wave.cosine;
    imaginary[k] = echoes.amplitude[k] * wave.sine;
  }
}

GLIDAR_SIMD void add(const Strip& a, const Strip& b, std::size_t count, Strip& sum) {
  for (std::size_t k = 0; k < count; ++k) sum[k] = a[k] + b[k];
}

/// The weights of a pixel itself and of each neighbour.
struct Shares {
  double own;
  double around;
};

inline double gathered(const Shares& shares, const Rows& rows, std::size_t k) {
  const double left = rows.middle[k] + rows.outer[k];
  const double right = rows.middle[k + 2] + rows.outer[k + 2];
  return shares.own * rows.middle[k + 1] + shares.around * (left + rows.outer[k + 1] + right);
}

GLIDAR_SIMD void gather_amplitude(const Shares& shares, const Rows& amplitude,
                                  std::span<double> out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = gathered(shares, amplitude, k);
}

GLIDAR_SIMD void gather_phasors(const Shares& shares, const Rows& real, const Rows& imaginary,
                                const double* amplitude, std::span<double> turns,
                                double* coherence) {
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const double x = gathered(shares, real, k);
    const double y = gathered(shares, imaginary, k);
    const double share = amplitude[k] > 0.0 ? std::sqrt(x * x + y * y) / amplitude[k] : 0.0;
    coherence[k] = share < coherence[k] ? share : coherence[k];
    turns[k] = atan2_turns(y, x);
  }
}

/// Three rows of echoes and their phasors.
struct Neighbourhood {
  Echoes above;
  Echoes middle;
  Echoes below;
  Rows amplitude;
  Rows real;
  Rows imaginary;
  Rows spare;
};

void make_rows(double per_m, std::size_t count, Neighbourhood& n) {
  make_phasors(n.middle, per_m, count, n.real.middle, n.imaginary.middle);
  make_phasors(n.above, per_m, count, n.real.outer, n.imaginary.outer);
  make_phasors(n.below, per_m, count, n.spare.middle, n.spare.outer);
  add(n.real.outer, n.spare.middle, count, n.real.outer);
  add(n.imaginary.outer, n.spare.outer, count, n.imaginary.outer);
}

/// Pixels of a batch that are in one row: `count` pixels from index `begin` of the batch.
struct PixelRun {
  std::size_t begin;
  std::size_t count;
};

void mix_row(const Shares& shares, std::span<const double> per_m, const PixelRun& row_run,
             Neighbourhood& n, WavePhases& phases) {
  const std::size_t wide = row_run.count + 2;
  double* amplitude = phases.amplitude.data() + row_run.begin;
  n.amplitude.middle = n.middle.amplitude;
  add(n.above.amplitude, n.below.amplitude, wide, n.amplitude.outer);
  gather_amplitude(shares, n.amplitude, {amplitude, row_run.count});
  for (std::size_t f = 0; f < per_m.size(); ++f) {
    make_rows(per_m[f], wide, n);
    gather_phasors(shares, n.real, n.imaginary, amplitude,
                   {phases.turns[f].data() + row_run.begin, row_run.count},
                   phases.coherence.data() + row_run.begin);
  }
}

}  // namespace

void mix(double fraction, std::span<const double> per_m, const NoiseView& view,
         const NoiseBatch& batch, WavePhases& phases) {
  const Shares shares{1.0 - fraction, fraction / 8.0};
  const std::size_t cols = view.beams.cols;
  Neighbourhood n;
  phases.coherence.fill(1.0);
  for (std::size_t i = 0; i < batch.count;) {
    const std::size_t row = (batch.first + i) / cols;
    const std::size_t col = (batch.first + i) % cols;
    const std::size_t count = std::min(cols - col, batch.count - i);
    const auto r = static_cast<std::ptrdiff_t>(row);
    const auto c = static_cast<std::ptrdiff_t>(col);
    load_echoes(view, r - 1, c, count, n.above);
    load_echoes(view, r, c, count, n.middle);
    load_echoes(view, r + 1, c, count, n.below);
    mix_row(shares, per_m, {i, count}, n, phases);
    i += count;
  }
}

}  // namespace glidar

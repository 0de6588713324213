// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/phasor_image.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <array>

namespace glidar::tof {
namespace {

constexpr double kInvTwoPi = 0.5 * std::numbers::inv_pi;

/// A neighbour of a pixel, with its weight relative to that of the pixel itself.
struct Neighbour {
  std::ptrdiff_t offset;
  double weight;
};

/// The eight neighbours, with a Gaussian of 3 px: exp(-d^2 / 18).
std::array<Neighbour, 8> neighbours(std::size_t width) {
  constexpr double kBeside = 0.9459594689067654;  // exp(-1/18)
  constexpr double kCorner = kBeside * kBeside;
  const auto w = static_cast<std::ptrdiff_t>(width);
  return {{{-w - 1, kCorner},
           {-w, kBeside},
           {-w + 1, kCorner},
           {-1, kBeside},
           {1, kBeside},
           {w - 1, kCorner},
           {w, kBeside},
           {w + 1, kCorner}}};
}

/// The sum of raw values with the phasors of their steps.
struct TapSum {
  Phasor value;
  bool is_saturated = false;
};

/// Sine and cosine of the phase of each step.
using TapPhases = std::array<SineCosine, kMaxTofTaps>;

TapPhases tap_phases(std::size_t taps) {
  TapPhases phases = {};
  const double per_tap = 1.0 / static_cast<double>(taps);
  for (std::size_t k = 0; k < taps; ++k) {
    phases[k] = sincos_turns(static_cast<double>(k) * per_tap);
  }
  return phases;
}

TapSum sum_taps(const TofImages& images, const TapPhases& phases, std::size_t first,
                double saturation_level) {
  TapSum sum;
  for (std::size_t k = 0; k < images.taps; ++k) {
    const auto level = static_cast<double>(images.level[first + k * pixel_count(images)]);
    // also true for NaN and infinity
    if (!(std::abs(level) < saturation_level)) sum.is_saturated = true;
    sum.value.re += level * phases[k].cosine;
    sum.value.im += level * phases[k].sine;
  }
  return sum;
}

Phasor scaled_and_turned(const Phasor& z, double scale, double turns) {
  if (turns == 0.0) return {scale * z.re, scale * z.im};
  const SineCosine turn = sincos_turns(turns);
  return {scale * (z.re * turn.cosine - z.im * turn.sine),
          scale * (z.re * turn.sine + z.im * turn.cosine)};
}

/// A pixel's neighbours at one frequency, summed up.
struct Smoothed {
  Phasor value;
  double phase_change = 0.0;
};

Smoothed smooth_pixel(const Phasor* pixel, const std::array<Neighbour, 8>& around,
                      const TofFilter& filter) {
  const double own = magnitude(*pixel);
  const bool is_bright = own >= filter.min_amplitude && own > 0.0;
  const double min_amplitude = is_bright ? filter.min_amplitude : 0.0;
  Smoothed sum{*pixel};
  double weights = 1.0;
  for (const Neighbour& n : around) {
    const Phasor& z = pixel[n.offset];
    const double other = magnitude(z);
    if (other < min_amplitude || other == 0.0) continue;
    const double cosine = is_bright ? (pixel->re * z.re + pixel->im * z.im) / (own * other) : 1.0;
    const double change = 0.5 * (1.0 - cosine);
    const double weight = n.weight * portable_exp(-filter.phase_weight * change);
    sum.phase_change += change;
    sum.value.re += weight * z.re;
    sum.value.im += weight * z.im;
    weights += weight;
  }
  sum.value.re /= weights;
  sum.value.im /= weights;
  return sum;
}

}  // namespace

PhasorImage make_phasors(const TofImages& images, const TofOptions& options,
                         const TofCalibration& calibration, ThreadPool* pool) {
  PhasorImage result{images.width, images.height, images.frequencies};
  const std::size_t pixels = result.pixels();
  result.value.resize(pixels * images.frequencies);
  result.is_saturated.resize(pixels);
  const TapPhases phases = tap_phases(images.taps);
  const auto find_pixel = [&](std::size_t f, std::size_t i) {
    const TapSum sum =
        sum_taps(images, phases, tap_offset(images, f, 0) + i, options.saturation_level);
    if (sum.is_saturated) {
      result.is_saturated[i] = 1;
      return;
    }
    const double gain = options.amplitude_gain.empty() ? 1.0 : options.amplitude_gain[f];
    const auto& offsets = calibration.phase_offset_rad;
    const double offset_rad = offsets.empty() ? 0.0 : double{offsets[f * pixels + i]};
    result.value[f * pixels + i] =
        scaled_and_turned(sum.value, gain * 2.0 / images.taps, -offset_rad * kInvTwoPi);
  };
  for_each_row(pool, images.height, [&](std::size_t row) {
    for (std::size_t i = row * images.width; i < (row + 1) * images.width; ++i) {
      if (!calibration.is_illuminated.empty() && calibration.is_illuminated[i] == 0) continue;
      for (std::size_t f = 0; f < images.frequencies; ++f) find_pixel(f, i);
    }
  });
  return result;
}

PhasorImage smooth(const PhasorImage& image, const TofFilter& filter, ThreadPool* pool) {
  PhasorImage result = image;
  const std::size_t pixels = image.pixels();
  const std::array<Neighbour, 8> around = neighbours(image.width);
  result.phase_change.assign(pixels, 0.0);
  if (image.width < 3 || image.height < 3) return result;
  const auto smooth_all = [&](std::size_t i) {
    for (std::size_t f = 0; f < image.frequencies; ++f) {
      const std::size_t at = f * pixels + i;
      const Smoothed smoothed = smooth_pixel(&image.value[at], around, filter);
      result.value[at] = smoothed.value;
      result.phase_change[i] = std::max(result.phase_change[i], smoothed.phase_change);
    }
  };
  for_each_row(pool, image.height - 2, [&](std::size_t inner) {
    const std::size_t first = (inner + 1) * image.width;
    for (std::size_t i = first + 1; i + 1 < first + image.width; ++i) smooth_all(i);
  });
  return result;
}

}  // namespace glidar::tof

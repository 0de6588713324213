// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/tof_decoding.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/unambiguous_range.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

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

double rounded(double value) {
  return std::floor(value + 0.5);
}

/// The range whose phases are the nearest: that of minimum variance, because phases have equal
/// errors, so that their weights are f^2.
double nearest_range_m(const Unwrapping& u, const PerFrequency& turns) {
  double along = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) along += turns[f] * u.per_m[f];
  return along / u.per_m_squares;
}

/// The distance of the phases from the line through 0 in the direction of the frequencies.
double misfit_rad(const Unwrapping& u, const PerFrequency& turns) {
  const double range_m = nearest_range_m(u, turns);
  double squares = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) {
    const double error = turns[f] - range_m * u.per_m[f];
    squares += error * error;
  }
  return kTwoPi * std::sqrt(squares);
}

/// nearest_range_m() from 0 on.
double weighted_range_m(const Unwrapping& u, const PerFrequency& turns) {
  const double range_m = nearest_range_m(u, turns);
  return range_m < 0.0 ? range_m + u.unambiguous_m : range_m;
}

/// The mean phase over the mean frequency.
double mean_range_m(const Unwrapping& u, const PerFrequency& turns) {
  double sum = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) sum += turns[f];
  return sum / u.per_m_sum;
}

Unwrapped best_fit(const Unwrapping& u, const PerFrequency& turns) {
  Unwrapped best = unwrap_candidate(u, turns, 0);
  for (std::size_t period = 1; period < u.periods; ++period) {
    const Unwrapped candidate = unwrap_candidate(u, turns, period);
    if (candidate.misfit_rad < best.misfit_rad) best = candidate;
  }
  return best;
}

/// In units of a thirtieth of the unambiguous range, a period of 80, 16 and 120 MHz is 3, 15 and 2
/// units. The phase of 16 MHz selects the period of 80 MHz; the parity of their position against
/// that of 120 MHz selects the half of the unambiguous range, and both select its period.
Unwrapped kinect_v2(const Unwrapping& u, const PerFrequency& turns) {
  constexpr double kHalf = 15.0;
  double fine = 3.0 * turns[0];
  double coarse = kHalf * turns[1];
  const double finest = 2.0 * turns[2];
  fine += 3.0 * rounded((coarse - fine) / 3.0);
  const double halves = 0.5 * std::abs(fine - finest);
  const double parity = 2.0 * (halves - std::floor(halves));
  if (parity > 0.5 && parity < 1.5) {
    fine += kHalf;
    coarse += kHalf;
  }
  const double finest_unwrapped = finest + 2.0 * rounded(0.5 * (fine - finest));
  Unwrapped result;
  result.turns = {fine / 3.0, coarse / kHalf, 0.5 * finest_unwrapped};
  result.range_m = mean_range_m(u, result.turns);
  result.misfit_rad = misfit_rad(u, result.turns);
  return result;
}

double misfit_limit_rad(const TofMisfitTest& test, const TofEvidence& pixel,
                        std::size_t frequencies) {
  if (test.exponent == 0.0) return std::clamp(test.scale, test.min_rad, test.max_rad);
  const double* const first = pixel.amplitude.data();
  const double* const last = first + frequencies;
  const double chosen =
      test.exponent > 0.0 ? *std::min_element(first, last) : *std::max_element(first, last);
  if (!(chosen > 0.0)) return test.exponent > 0.0 ? test.min_rad : test.max_rad;
  return std::max(test.min_rad,
                  std::min(test.max_rad, test.scale * portable_pow(chosen, test.exponent)));
}

void require_size(const char* where, std::size_t found, std::size_t needed) {
  if (found == 0 || found == needed) return;
  throw Error(
      {where, "has " + std::to_string(found) + " numbers",
       std::to_string(needed) + ", one for each pixel" + (needed == 0 ? "" : " of the raw images"),
       ""});
}

void require_images(const TofImages& images, const TofOptions& options) {
  if (images.frequencies != options.frequencies_hz.size() || images.taps != options.taps) {
    throw Error({"raw images",
                 "there are " + std::to_string(images.frequencies) + " frequencies with " +
                     std::to_string(images.taps) + " phase steps",
                 "as the options: " + std::to_string(options.frequencies_hz.size()) + " with " +
                     std::to_string(options.taps),
                 ""});
  }
  constexpr std::size_t kMaxPixels = std::size_t{1} << 26U;
  const std::size_t pixels = pixel_count(images);
  if (pixels == 0 || pixels > kMaxPixels) {
    throw Error(
        {"raw images",
         "have " + std::to_string(images.width) + "x" + std::to_string(images.height) + " pixels",
         "1 to " + std::to_string(kMaxPixels), ""});
  }
  const std::size_t needed = pixels * images.frequencies * images.taps;
  if (images.level.size() == needed) return;
  throw Error({"raw images", "have " + std::to_string(images.level.size()) + " values",
               std::to_string(needed) + ": frequencies x steps x pixels", ""});
}

void require_calibration(const TofCalibration& calibration, const TofImages& images) {
  const std::size_t pixels = pixel_count(images);
  require_size("depth_per_range", calibration.depth_per_range.size(), pixels);
  require_size("phase_offset_rad", calibration.phase_offset_rad.size(),
               pixels * images.frequencies);
  require_size("is_illuminated", calibration.is_illuminated.size(), pixels);
}

void resize(const PhasorImage& phasors, Decoding& decoding) {
  const std::size_t pixels = phasors.pixels();
  decoding.depths = {phasors.width, phasors.height, std::vector<double>(pixels),
                     std::vector<double>(pixels)};
  TofMeasurement& result = decoding.measurement;
  result.width = static_cast<std::uint32_t>(phasors.width);
  result.height = static_cast<std::uint32_t>(phasors.height);
  result.frequencies = static_cast<std::uint32_t>(phasors.frequencies);
  result.range_m.resize(pixels);
  result.status.resize(pixels);
  result.amplitude.resize(pixels * phasors.frequencies);
  result.phase_rad.resize(pixels * phasors.frequencies);
  result.misfit_rad.resize(pixels);
}

/// The result of a pixel without the tests of edges.
void store(const TofEvidence& pixel, const TofOptions& options, std::size_t i, Decoding& decoding) {
  TofMeasurement& result = decoding.measurement;
  const std::size_t pixels = result.status.size();
  const TofStatus status = find_status(pixel, options);
  result.status[i] = status;
  result.range_m[i] = status == TofStatus::valid ? pixel.unwrapped.range_m : kNaN;
  for (std::size_t f = 0; f < result.frequencies; ++f) {
    result.amplitude[f * pixels + i] = static_cast<float>(pixel.amplitude[f]);
    result.phase_rad[f * pixels + i] = static_cast<float>(kTwoPi * pixel.turns[f]);
  }
  const bool has_phases = status != TofStatus::not_illuminated && status != TofStatus::saturated &&
                          status != TofStatus::low_signal;
  result.misfit_rad[i] = has_phases ? static_cast<float>(pixel.unwrapped.misfit_rad) : kNaNf;
  decoding.depths.amplitude_sum[i] = pixel.amplitude_sum;
  decoding.depths.depth_m[i] = has_phases && has_fit(pixel) ? pixel.depth_m : 0.0;
}

void test_edges(const TofOptions& options, ThreadPool* pool, Decoding& decoding) {
  if (!options.edge_test && !options.filter) return;
  TofMeasurement& result = decoding.measurement;
  for_each_row(pool, result.height, [&](std::size_t row) {
    for (std::size_t i = row * result.width; i < (row + 1) * result.width; ++i) {
      if (result.status[i] != TofStatus::valid) continue;
      const EdgeEvidence edge = gather_edge_evidence(decoding.depths, decoding.phasors, options, i);
      if (!is_depth_edge(edge, options) && !is_phase_edge(edge, options)) continue;
      result.status[i] = TofStatus::edge;
      result.range_m[i] = kNaN;
    }
  });
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

Unwrapping make_unwrapping(const TofOptions& options) {
  const std::vector<double>& f = options.frequencies_hz;
  Unwrapping u;
  u.method = options.unwrapping;
  u.frequencies = f.size();
  u.highest = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
  u.unambiguous_m = unambiguous_range_m(f);
  for (std::size_t k = 0; k < f.size(); ++k) {
    u.per_m[k] = f[k] / kHalfLight_m_per_s;
    u.per_m_sum += u.per_m[k];
    u.per_m_squares += u.per_m[k] * u.per_m[k];
  }
  u.periods =
      static_cast<std::size_t>(std::max(1.0, rounded(u.unambiguous_m * u.per_m[u.highest])));
  return u;
}

Unwrapped unwrap_candidate(const Unwrapping& u, const PerFrequency& turns, std::size_t period) {
  Unwrapped result;
  const double highest = turns[u.highest] + static_cast<double>(period);
  const double range_m = highest / u.per_m[u.highest];
  for (std::size_t f = 0; f < u.frequencies; ++f) {
    result.turns[f] = turns[f] + rounded(range_m * u.per_m[f] - turns[f]);
  }
  result.turns[u.highest] = highest;
  const bool is_kinect = u.method == TofUnwrapping::kinect_v2;
  result.range_m = is_kinect ? mean_range_m(u, result.turns) : weighted_range_m(u, result.turns);
  result.misfit_rad = misfit_rad(u, result.turns);
  return result;
}

Unwrapped unwrap(const Unwrapping& u, const PerFrequency& turns) {
  return u.method == TofUnwrapping::kinect_v2 ? kinect_v2(u, turns) : best_fit(u, turns);
}

TofEvidence gather_evidence(const PhasorImage& phasors, const Unwrapping& unwrapping,
                            const TofOptions& options, const TofCalibration& calibration,
                            std::size_t pixel) {
  TofEvidence found;
  found.is_illuminated =
      calibration.is_illuminated.empty() || calibration.is_illuminated[pixel] != 0;
  found.is_saturated = phasors.is_saturated[pixel] != 0;
  for (std::size_t f = 0; f < phasors.frequencies; ++f) {
    const Phasor& z = phasors.value[f * phasors.pixels() + pixel];
    found.amplitude[f] = magnitude(z);
    found.turns[f] = atan2_turns(z.im, z.re);
    found.amplitude_sum += found.amplitude[f];
  }
  found.min_amplitude =
      *std::min_element(found.amplitude.begin(), found.amplitude.begin() + phasors.frequencies);
  found.misfit_limit_rad = misfit_limit_rad(options.misfit_test, found, phasors.frequencies);
  found.unwrapped = unwrap(unwrapping, found.turns);
  const auto& cosines = calibration.depth_per_range;
  found.depth_m = found.unwrapped.range_m * (cosines.empty() ? 1.0 : double{cosines[pixel]});
  return found;
}

bool has_signal(const TofEvidence& pixel, const TofOptions& options) {
  return pixel.min_amplitude > 0.0 && pixel.min_amplitude >= options.min_amplitude &&
         pixel.amplitude_sum >= options.min_amplitude_sum;
}

bool has_fit(const TofEvidence& pixel) {
  return pixel.unwrapped.misfit_rad <= pixel.misfit_limit_rad && pixel.unwrapped.range_m >= 0.0;
}

TofStatus find_status(const TofEvidence& pixel, const TofOptions& options) {
  if (!pixel.is_illuminated) return TofStatus::not_illuminated;
  if (pixel.is_saturated) return TofStatus::saturated;
  if (!has_signal(pixel, options)) return TofStatus::low_signal;
  if (!has_fit(pixel)) return TofStatus::ambiguous;
  if (pixel.depth_m < options.near_m) return TofStatus::too_near;
  return pixel.depth_m > options.far_m ? TofStatus::too_far : TofStatus::valid;
}

EdgeEvidence gather_edge_evidence(const DecodedDepths& image, const PhasorImage& phasors,
                                  const TofOptions& options, std::size_t pixel) {
  EdgeEvidence edge;
  const std::size_t row = pixel / image.width;
  const std::size_t column = pixel % image.width;
  edge.is_border = row == 0 || column == 0 || row + 1 == image.height || column + 1 == image.width;
  if (!phasors.phase_change.empty()) edge.phase_change = phasors.phase_change[pixel];
  if (edge.is_border) return edge;
  const double own_m = image.depth_m[pixel];
  double near_m = own_m;
  double far_m = own_m;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t first = pixel - image.width - 1; first <= pixel + image.width - 1;
       first += image.width) {
    for (std::size_t i = first; i < first + 3; ++i) {
      sum += image.amplitude_sum[i];
      squares += image.amplitude_sum[i] * image.amplitude_sum[i];
      if (!(image.depth_m[i] > 0.0)) continue;
      near_m = std::min(near_m, image.depth_m[i]);
      far_m = std::max(far_m, image.depth_m[i]);
    }
  }
  const double mean = options.edge_test ? options.edge_test->min_mean_amplitude : 0.0;
  const double deviation = std::sqrt(std::max(0.0, 9.0 * squares - sum * sum)) / 9.0;
  const double divisor = std::max(sum / 9.0, mean);
  edge.amplitude_deviation = divisor > 0.0 ? deviation / divisor : 0.0;
  edge.near_step_m = own_m - near_m;
  edge.far_step_m = far_m - own_m;
  return edge;
}

bool is_depth_edge(const EdgeEvidence& edge, const TofOptions& options) {
  if (!options.edge_test || edge.is_border) return false;
  const TofEdgeTest& test = *options.edge_test;
  return edge.amplitude_deviation >= test.amplitude_deviation &&
         edge.near_step_m > test.near_step_m && edge.far_step_m > test.far_step_m &&
         std::max(edge.near_step_m, edge.far_step_m) > test.max_step_m &&
         0.5 * (edge.near_step_m + edge.far_step_m) > test.mean_step_m;
}

bool is_phase_edge(const EdgeEvidence& edge, const TofOptions& options) {
  return options.filter && !edge.is_border && edge.phase_change >= options.filter->max_phase_change;
}

Decoding decode(const TofImages& images, const TofOptions& options,
                const TofCalibration& calibration, ThreadPool* pool) {
  validate(options);
  require_images(images, options);
  require_calibration(calibration, images);
  Decoding decoding;
  decoding.unwrapping = make_unwrapping(options);
  decoding.phasors = make_phasors(images, options, calibration, pool);
  if (options.filter) decoding.phasors = smooth(decoding.phasors, *options.filter, pool);
  resize(decoding.phasors, decoding);
  for_each_row(pool, images.height, [&](std::size_t row) {
    for (std::size_t i = row * images.width; i < (row + 1) * images.width; ++i) {
      store(gather_evidence(decoding.phasors, decoding.unwrapping, options, calibration, i),
            options, i, decoding);
    }
  });
  test_edges(options, pool, decoding);
  return decoding;
}

}  // namespace glidar::tof

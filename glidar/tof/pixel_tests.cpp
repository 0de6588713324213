// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/pixel_tests.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::tof {
namespace {

double misfit_limit_rad(const TofMisfitTest& test, const PixelEvidence& pixel,
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

}  // namespace

PixelEvidence gather_evidence(const PhasorImage& phasors, const Unwrapping& unwrapping,
                              const TofOptions& options, const TofCalibration& calibration,
                              std::size_t pixel) {
  PixelEvidence found;
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

bool has_signal(const PixelEvidence& pixel, const TofOptions& options) {
  return pixel.min_amplitude > 0.0 && pixel.min_amplitude >= options.min_amplitude &&
         pixel.amplitude_sum >= options.min_amplitude_sum;
}

bool has_fit(const PixelEvidence& pixel) {
  return pixel.unwrapped.misfit_rad <= pixel.misfit_limit_rad && pixel.unwrapped.range_m >= 0.0;
}

TofStatus find_status(const PixelEvidence& pixel, const TofOptions& options) {
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

}  // namespace glidar::tof

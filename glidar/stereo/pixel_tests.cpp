// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/pixel_tests.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/stereo/kernel.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::stereo {

bool is_inside(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.column >= options.min_disparity_px + pixel.winner + window_radius_px(options);
}

bool has_texture(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.step_sum >= options.min_texture * pixel.window_pixels;
}

bool is_unsaturated(const PixelEvidence& pixel) {
  return 2 * pixel.saturated_pixels <= pixel.window_pixels;
}

bool is_in_range(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.winner > 0 && pixel.winner + 1 < options.disparities;
}

bool is_unique(const PixelEvidence& pixel) {
  return pixel.rivals == 0;
}

bool is_consistent(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!options.has_left_right_test) return true;
  const std::uint32_t difference =
      std::max(pixel.winner, pixel.right_winner) - std::min(pixel.winner, pixel.right_winner);
  return difference <= options.left_right_px;
}

bool is_beside_border(const PixelEvidence& pixel, const StereoOptions& options) {
  return static_cast<double>(pixel.column) <
         static_cast<double>(pixel.next_disparity_px) + window_radius_px(options);
}

StereoStatus classify(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!is_inside(pixel, options)) return StereoStatus::border;
  const bool is_saturated = !is_unsaturated(pixel);
  if (!has_texture(pixel, options)) {
    return is_saturated ? StereoStatus::saturated : StereoStatus::no_texture;
  }
  const bool is_found = is_in_range(pixel, options) && is_unique(pixel);
  if (is_found && is_consistent(pixel, options)) return StereoStatus::valid;
  if (is_beside_border(pixel, options)) return StereoStatus::border;
  if (!is_in_range(pixel, options)) return StereoStatus::out_of_range;
  if (is_found) return StereoStatus::left_right;
  return is_saturated ? StereoStatus::saturated : StereoStatus::ambiguous;
}

std::uint32_t without_neighbours(std::uint32_t rivals, std::uint32_t winner,
                                 const StereoOptions& options, const std::int16_t* sums) {
  if (options.uniqueness_percent == 0) return 0;
  const auto is_rival = [&](std::uint32_t lane) {
    const std::int64_t best = sums[winner] + kSumOffset;
    return (sums[lane] + kSumOffset) * std::int64_t{100 - options.uniqueness_percent} <= 100 * best;
  };
  std::uint32_t neighbours = 1;  // the winner itself
  if (winner > 0 && is_rival(winner - 1)) ++neighbours;
  if (winner + 1 < options.disparities && is_rival(winner + 1)) ++neighbours;
  return rivals - neighbours;
}

double subpixel_offset(StereoSubpixel curve, double below, double middle, double above) {
  if (curve == StereoSubpixel::none) return 0.0;
  const double bend = curve == StereoSubpixel::v_shape ? std::max(below, above) - middle
                                                       : below + above - 2.0 * middle;
  return bend > 0.0 ? (below - above) / (2.0 * bend) : 0.0;
}

double corrected_offset(double offset, double a_factor) {
  return a_factor == 0.0 ? offset : offset + a_factor * sincos_turns(offset).sine;
}

double rounded_disparity(double disparity_px, std::uint32_t steps_per_px) {
  if (steps_per_px == 0) return disparity_px;
  return std::floor(disparity_px * steps_per_px + 0.5) / steps_per_px;
}

}  // namespace glidar::stereo

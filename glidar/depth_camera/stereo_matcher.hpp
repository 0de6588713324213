// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/stereo_costs.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar::stereo {

/// What the tests of a pixel read.
struct PixelEvidence {
  std::uint32_t column = 0;
  std::uint32_t winner = 0;        ///< lane: disparity minus min_disparity_px
  std::uint32_t right_winner = 0;  ///< lane that the matched right pixel selects
  std::uint32_t rivals = 0;        ///< lanes further than 1 from the winner that cost hardly more
  std::uint32_t step_sum = 0;      ///< steps of grey levels in the window
  std::uint32_t saturated_pixels = 0;
  std::uint32_t window_pixels = 1;
  float next_disparity_px = -1.0F;  ///< of the next valid pixel on the right; negative: none
};

/// The tests one by one: true where the pixel passes.
bool is_inside(const PixelEvidence& pixel, const StereoOptions& options);
bool has_texture(const PixelEvidence& pixel, const StereoOptions& options);
bool is_unsaturated(const PixelEvidence& pixel);
bool is_in_range(const PixelEvidence& pixel, const StereoOptions& options);
bool is_unique(const PixelEvidence& pixel);
bool is_consistent(const PixelEvidence& pixel, const StereoOptions& options);

/// Whether the window of a match at the disparity of the next valid pixel on the right crosses the
/// edge of the right image.
bool is_beside_border(const PixelEvidence& pixel, const StereoOptions& options);

/// The first test that fails. Where the search has no unique, consistent winner beside the edge of
/// the right image, that edge is the cause.
StereoStatus classify(const PixelEvidence& pixel, const StereoOptions& options);

/// The lanes that rival the winner, from those of the whole row of costs that do, as the neighbours
/// of the winner do not count.
std::uint32_t without_neighbours(std::uint32_t rivals, std::uint32_t winner,
                                 const StereoOptions& options, const std::int16_t* sums);

/// The minimum between three summed costs, as an offset from the middle one, -0.5 to 0.5 px.
double subpixel_offset(StereoSubpixel curve, double below, double middle, double above);

/// offset + a_factor sin(2 pi offset)
double corrected_offset(double offset, double a_factor);

/// A disparity rounded to a multiple of 1 / steps_per_px.
double rounded_disparity(double disparity_px, std::uint32_t steps_per_px);

/// match_stereo() with the costs that lead to the result, whose memory `volume` keeps for the next
/// pair. Its sums are complete only if the run keeps costs. Throws Error as match_stereo() does.
StereoMatch match_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run, CostVolume& volume);

/// The evidence of a pixel of a match, computed again from complete sums.
PixelEvidence gather_evidence(const CostVolume& volume, const StereoMatch& match,
                              const GreyImage& left, const StereoOptions& options,
                              std::size_t pixel);

}  // namespace glidar::stereo

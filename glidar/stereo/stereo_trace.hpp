// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/stereo/stereo_match.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// One test of a pixel.
struct StereoTest {
  StereoStatus failure = StereoStatus::valid;  ///< the status of a pixel that fails it
  bool has_passed = true;
  std::string finding;  ///< the numbers that were compared
};

/// How a pixel of the left image got its disparity or status.
struct StereoTrace {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  StereoStatus status = StereoStatus::valid;
  std::uint32_t min_disparity_px = 0;
  std::vector<std::uint16_t> matching_cost =
      {};  ///< Hamming distances summed over the box, a disparity each
  std::vector<std::uint16_t> summed_cost =
      {};                              ///< path costs summed over the paths, one for each disparity
  std::uint32_t winner_px = 0;         ///< disparity of the least summed cost
  std::uint32_t right_winner_px = 0;   ///< disparity that the right image selects there
  double offset_px = 0.0;              ///< minimum of the curve, from the winner; 0 at the ends
  double corrected_offset_px = 0.0;    ///< with the a-factor
  double disparity_px = 0.0;           ///< rounded; also for pixels that fail a test
  std::vector<StereoTest> tests = {};  ///< all of them, in their order
};

/// Matches the pair and reports on one pixel, from the same costs and tests. Throws Error as
/// match_stereo() does, and when the pixel is outside the image.
StereoTrace explain_stereo(const GreyImage& left, const GreyImage& right,
                           const StereoOptions& options, std::array<std::uint32_t, 2> column_row,
                           const StereoRun& run = {});

/// The trace as lines of text: result, tests and the costs around the winner.
std::string format_stereo_trace(const StereoTrace& trace);

}  // namespace glidar

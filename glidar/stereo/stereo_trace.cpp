// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/stereo_trace.hpp>

#include <glidar/core/decimal_text.hpp>
#include <glidar/core/error.hpp>
#include <glidar/stereo/matcher.hpp>

#include <algorithm>

namespace glidar {

namespace {

using stereo::PixelEvidence;

/// What makes the edge the cause of a later test's failure.
std::string border_text(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!is_beside_border(pixel, options)) return "";
  return "; the next disparity on the right, " +
         number_text(static_cast<double>(pixel.next_disparity_px)) + ", needs a higher column";
}

std::vector<StereoTest> list_tests(const PixelEvidence& pixel, const StereoOptions& options) {
  const std::uint32_t disparity = options.min_disparity_px + pixel.winner;
  const double pixels = pixel.window_pixels;
  const std::uint32_t last = options.min_disparity_px + options.disparities - 1;
  return {
      {StereoStatus::border, is_inside(pixel, options),
       "column " + std::to_string(pixel.column) + ", needed: disparity " +
           std::to_string(disparity) + " + window " + std::to_string(window_radius_px(options)) +
           border_text(pixel, options)},
      {StereoStatus::no_texture, has_texture(pixel, options),
       "mean step of grey levels " + decimal_text(pixel.step_sum / pixels) +
           ", needed: " + decimal_text(options.min_texture)},
      {StereoStatus::saturated, is_unsaturated(pixel),
       decimal_text(100.0 * pixel.saturated_pixels / pixels) +
           " % of the window is saturated; above 50 % it is the cause of no texture or ambiguity"},
      {StereoStatus::out_of_range, is_in_range(pixel, options),
       "winner " + std::to_string(disparity) +
           ", search: " + std::to_string(options.min_disparity_px) + " to " + std::to_string(last)},
      {StereoStatus::ambiguous, is_unique(pixel),
       std::to_string(pixel.rivals) + " other disparities cost less than " +
           std::to_string(options.uniqueness_percent) + " % more"},
      {StereoStatus::left_right, is_consistent(pixel, options),
       "left " + std::to_string(disparity) + ", right " +
           std::to_string(options.min_disparity_px + pixel.right_winner) +
           ", allowed difference: " +
           (options.has_left_right_test ? std::to_string(options.left_right_px) : "any")}};
}

void copy_costs_of_pixel(const stereo::CostVolume& volume, StereoTrace& trace) {
  const std::size_t first = volume.offset(trace.row) + trace.column * volume.lanes;
  for (std::size_t i = first; i < first + volume.disparities; ++i) {
    trace.matching_cost.push_back(static_cast<std::uint16_t>(volume.cost.data()[i]));
    trace.summed_cost.push_back(
        static_cast<std::uint16_t>(volume.sum.data()[i] + stereo::kSumOffset));
  }
}

void set_disparity(const PixelEvidence& pixel, const StereoOptions& options, StereoTrace& trace) {
  if (is_in_range(pixel, options)) {
    const std::uint16_t* const at = trace.summed_cost.data() + pixel.winner;
    trace.offset_px = stereo::subpixel_offset(options.subpixel, at[-1], at[0], at[1]);
  }
  trace.corrected_offset_px = stereo::corrected_offset(trace.offset_px, options.a_factor);
  trace.disparity_px =
      stereo::rounded_disparity(trace.winner_px + trace.corrected_offset_px, options.steps_per_px);
}

std::string cost_lines(const StereoTrace& trace) {
  constexpr std::uint32_t kShown = 4;  // on both sides of the winner
  const std::uint32_t lane = trace.winner_px - trace.min_disparity_px;
  const auto count = static_cast<std::uint32_t>(trace.summed_cost.size());
  std::string text = "  disparity  matching cost  summed cost\n";
  for (std::uint32_t d = lane > kShown ? lane - kShown : 0; d < count && d <= lane + kShown; ++d) {
    const auto cell = [](std::uint32_t value, std::size_t width) {
      const std::string digits = std::to_string(value);
      return std::string(width > digits.size() ? width - digits.size() : 0, ' ') + digits;
    };
    text += cell(trace.min_disparity_px + d, 11) + cell(trace.matching_cost[d], 15) +
            cell(trace.summed_cost[d], 13) + (d == lane ? "  winner\n" : "\n");
  }
  return text;
}

}  // namespace

StereoTrace explain_stereo(const GreyImage& left, const GreyImage& right,
                           const StereoOptions& options, std::array<std::uint32_t, 2> column_row,
                           const StereoRun& run) {
  require_pair(left, right, options);
  const auto [column, row] = column_row;
  if (column >= left.width || row >= left.height) {
    throw Error({"pixel to explain",
                 std::to_string(column) + "," + std::to_string(row) + " is outside the image",
                 "columns 0 to " + std::to_string(left.width - 1) + ", rows 0 to " +
                     std::to_string(left.height - 1),
                 ""});
  }
  StereoRun kept = run;
  kept.keeps_costs = true;
  stereo::CostVolume volume;
  const StereoMatch match = stereo::match_pair(left, right, options, kept, volume);
  const std::size_t index = std::size_t{row} * left.width + column;
  const PixelEvidence pixel = stereo::gather_evidence(volume, match, left, options, index);
  StereoTrace trace = {.column = column,
                       .row = row,
                       .status = match.status[index],
                       .min_disparity_px = options.min_disparity_px,
                       .winner_px = options.min_disparity_px + pixel.winner,
                       .right_winner_px = options.min_disparity_px + pixel.right_winner};
  copy_costs_of_pixel(volume, trace);
  set_disparity(pixel, options, trace);
  trace.tests = list_tests(pixel, options);
  return trace;
}

std::string format_stereo_trace(const StereoTrace& trace) {
  std::string text = "pixel " + std::to_string(trace.column) + "," + std::to_string(trace.row) +
                     ": " + to_string(trace.status) + "\n";
  text += "disparity " + number_text(trace.disparity_px) + " px: winner " +
          std::to_string(trace.winner_px) + ", minimum of the curve " +
          decimal_text(trace.offset_px) + ", with a-factor " +
          decimal_text(trace.corrected_offset_px) + "\n";
  for (const StereoTest& test : trace.tests) {
    text += std::string(test.has_passed ? "  passed  " : "  failed  ") + to_string(test.failure) +
            ": " + test.finding + "\n";
  }
  return text + cost_lines(trace);
}

}  // namespace glidar

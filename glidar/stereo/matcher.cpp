// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/matcher.hpp>

#include <glidar/core/instruction_set.hpp>
#include <glidar/core/progress_counter.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/stereo/kernels.hpp>
#include <glidar/stereo/path_sums.hpp>
#include <glidar/stereo/window_sums.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace glidar::stereo {

namespace {

std::uint32_t saturation_level(const GreyImage& image, const StereoOptions& options) {
  return options.saturation_level == 0 ? image.max_level : options.saturation_level;
}

/// Memory of a thread for the winners of a row.
struct WinnerWorkspace {
  std::vector<std::int16_t> best;
  std::vector<std::int16_t> winner;
  std::vector<std::int16_t> rivals;
  std::vector<std::int16_t> mirror_best;
  std::vector<std::int16_t> mirror_winner;
};

WinnerWorkspace make_workspace(const CostVolume& volume) {
  const std::size_t width = volume.width;
  return {std::vector<std::int16_t>(width), std::vector<std::int16_t>(width),
          std::vector<std::int16_t>(width), std::vector<std::int16_t>(width + volume.lanes),
          std::vector<std::int16_t>(width + volume.lanes)};
}

/// Selects winners row by row and tests them.
class WinnerRows {
 public:
  WinnerRows(const CostSource& source, const CostVolume& volume, const WindowSums& windows,
             std::size_t threads, StereoMatch& match)
      : source_(source),
        volume_(volume),
        windows_(windows),
        workspaces_(threads, make_workspace(volume)),
        match_(match) {}

  void finish(std::size_t worker, std::size_t y, const std::int16_t* sums) {
    WinnerWorkspace& work = workspaces_[worker];
    source_.kernel.win({.sum = sums,
                        .width = volume_.width,
                        .lanes = volume_.lanes,
                        .disparities = volume_.disparities,
                        .uniqueness_percent = source_.options.uniqueness_percent,
                        .best = work.best.data(),
                        .winner = work.winner.data(),
                        .rivals = work.rivals.data(),
                        .mirror_best = work.mirror_best.data(),
                        .mirror_winner = work.mirror_winner.data()});
    float next_disparity_px = -1.0F;
    for (std::size_t x = volume_.width; x-- > 0;) {
      const std::int16_t* const at = sums + x * volume_.lanes;
      PixelEvidence pixel = evidence(work, x, y, at);
      pixel.next_disparity_px = next_disparity_px;
      set_pixel(x, y, pixel, at);
      const float disparity_px = match_.disparity_px[y * volume_.width + x];
      if (!std::isnan(disparity_px)) next_disparity_px = disparity_px;
    }
  }

 private:
  [[nodiscard]] PixelEvidence evidence(const WinnerWorkspace& work, std::size_t x, std::size_t y,
                                       const std::int16_t* sums) const {
    const auto winner = static_cast<std::uint32_t>(work.winner[x]);
    const std::size_t pixel = y * volume_.width + x;
    const std::size_t mirrored = volume_.width - 1 - x + winner;
    return {.column = static_cast<std::uint32_t>(x),
            .winner = winner,
            .right_winner = static_cast<std::uint32_t>(work.mirror_winner[mirrored]),
            .rivals = without_neighbours(static_cast<std::uint32_t>(work.rivals[x]), winner,
                                         source_.options, sums),
            .step_sum = windows_.step[pixel],
            .saturated_pixels = windows_.saturated[pixel],
            .window_pixels = windows_.pixels[pixel]};
  }

  void set_pixel(std::size_t x, std::size_t y, const PixelEvidence& evidence,
                 const std::int16_t* sums) {
    const StereoOptions& options = source_.options;
    const std::size_t pixel = y * volume_.width + x;
    const StereoStatus status = classify(evidence, options);
    match_.status[pixel] = status;
    if (status != StereoStatus::valid) return;
    const std::int16_t* const at = sums + evidence.winner;
    // a test keeps winners off both ends of the search
    const double offset =
        corrected_offset(subpixel_offset(options.subpixel, at[-1], at[0], at[1]), options.a_factor);
    match_.disparity_px[pixel] = static_cast<float>(rounded_disparity(
        options.min_disparity_px + evidence.winner + offset, options.steps_per_px));
  }

  const CostSource& source_;
  const CostVolume& volume_;
  const WindowSums& windows_;
  std::vector<WinnerWorkspace> workspaces_;
  StereoMatch& match_;
};

StereoMatch empty_match(const GreyImage& image, const StereoOptions& options) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  StereoMatch match;
  match.width = image.width;
  match.height = image.height;
  match.disparities = options.disparities;
  match.min_disparity_px = options.min_disparity_px;
  match.disparity_px.assign(pixels, kNaNf);
  match.status.assign(pixels, StereoStatus::valid);
  return match;
}

/// The lane that right column `column` of row y selects: the first of its least sums.
std::uint32_t right_winner(const CostVolume& volume, std::int64_t column, std::size_t y) {
  std::uint32_t winner = 0;
  std::int16_t lowest = 32767;
  for (std::size_t d = 0; d < volume.disparities; ++d) {
    const std::int64_t x = column + static_cast<std::int64_t>(d);
    if (x < 0 || x >= static_cast<std::int64_t>(volume.width)) continue;
    const std::int16_t sum =
        volume.sum.data()[volume.offset(y) + static_cast<std::size_t>(x) * volume.lanes + d];
    if (sum >= lowest) continue;
    lowest = sum;
    winner = static_cast<std::uint32_t>(d);
  }
  return winner;
}

void add_window(const GreyImage& image, const StereoOptions& options, std::uint32_t x,
                std::uint32_t y, PixelEvidence& evidence) {
  const std::uint32_t radius = window_radius_px(options);
  evidence.window_pixels = 0;
  for (std::uint32_t v = y > radius ? y - radius : 0; v <= y + radius && v < image.height; ++v) {
    for (std::uint32_t u = x > radius ? x - radius : 0; u <= x + radius && u < image.width; ++u) {
      const std::size_t pixel = std::size_t{v} * image.width + u;
      const int level = image.level[pixel];
      ++evidence.window_pixels;
      if (image.level[pixel] >= saturation_level(image, options)) ++evidence.saturated_pixels;
      if (u + 1 == image.width) continue;
      evidence.step_sum += static_cast<std::uint32_t>(std::abs(level - image.level[pixel + 1]));
    }
  }
}

}  // namespace

StereoMatch match_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run, CostVolume& volume) {
  require_pair(left, right, options);
  const InstructionSet set = run.instruction_set.empty()
                                 ? select_instruction_set()
                                 : find_instruction_set(run.instruction_set);
  resize_volume(left, options.disparities, volume);
  StereoMatch match = empty_match(left, options);
  const CostSource source(left, right, options, kernel_for(set));
  const WindowSums windows =
      sum_windows(left, window_radius_px(options), saturation_level(left, options), run.pool);
  const std::size_t threads = run.pool == nullptr ? 1 : run.pool->threads();
  WinnerRows rows(source, volume, windows, threads, match);
  const auto on_row = [&](std::size_t worker, std::size_t y, const std::int16_t* sums) {
    rows.finish(worker, y, sums);
  };
  ProgressCounter progress(run.progress, progress_rows(volume));
  sum_paths(source, run, volume, RowSumsFunction(on_row), progress);
  progress.finish();
  return match;
}

PixelEvidence gather_evidence(const CostVolume& volume, const StereoMatch& match,
                              const GreyImage& left, const StereoOptions& options,
                              std::size_t pixel) {
  const auto x = static_cast<std::uint32_t>(pixel % volume.width);
  const auto y = static_cast<std::uint32_t>(pixel / volume.width);
  const std::int16_t* const sums = volume.sum.data() + pixel * volume.lanes;
  const auto count = static_cast<std::ptrdiff_t>(volume.disparities);
  const auto winner = static_cast<std::uint32_t>(std::min_element(sums, sums + count) - sums);
  PixelEvidence evidence = {.column = x, .winner = winner};
  evidence.right_winner =
      right_winner(volume, std::int64_t{x} - static_cast<std::int64_t>(winner), y);
  const std::int64_t best = sums[winner] + kSumOffset;
  const auto is_rival = [&](std::int16_t sum) {
    return (sum + kSumOffset) * std::int64_t{100 - options.uniqueness_percent} <= 100 * best;
  };
  const auto rivals = static_cast<std::uint32_t>(std::count_if(sums, sums + count, is_rival));
  evidence.rivals = without_neighbours(rivals, winner, options, sums);
  evidence.window_pixels = 0;
  add_window(left, options, x, y, evidence);
  const auto row_end =
      match.disparity_px.begin() + static_cast<std::ptrdiff_t>((std::size_t{y} + 1) * volume.width);
  const auto next =
      std::find_if(match.disparity_px.begin() + static_cast<std::ptrdiff_t>(pixel + 1), row_end,
                   [](float disparity_px) { return !std::isnan(disparity_px); });
  if (next != row_end) evidence.next_disparity_px = *next;
  return evidence;
}

}  // namespace glidar::stereo

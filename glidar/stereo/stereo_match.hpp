// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/grey_image.hpp>
#include <glidar/core/report.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/stereo/stereo_options.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace glidar {

/// Why a pixel has no disparity: the first test that it fails, in this order.
enum class StereoStatus : std::uint8_t {
  valid,
  border,        ///< the window of the match crosses the edge of the right image
  no_texture,    ///< grey levels hardly change in the window
  saturated,     ///< most of the window is saturated, and it has no texture or no unique match
  out_of_range,  ///< the winner is the first or the last disparity of the search
  ambiguous,     ///< another disparity costs hardly more
  left_right     ///< the right view selects another disparity: occluded, or a wrong match
};
inline constexpr std::size_t kStereoStatusCount = 7;

/// "valid", "border", "no_texture", "saturated", "out_of_range", "ambiguous" or "left_right".
const char* to_string(StereoStatus status);

/// The result of match_stereo(), for each pixel of the left image, row by row from the top.
struct StereoMatch {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t disparities = 0;
  std::uint32_t min_disparity_px = 0;
  std::vector<float> disparity_px;   ///< column in the left minus that in the right image, or NaN
  std::vector<StereoStatus> status;  ///< as many
  /// Summed path costs, for each pixel from min_disparity_px on; empty unless requested.
  std::vector<std::uint16_t> cost;
};

/// What match_stereo() does besides the disparities.
struct StereoRun {
  ThreadPool* pool = nullptr;  ///< null: one thread
  bool keeps_costs = false;
  ProgressCallback progress = {};
  std::string_view instruction_set = {};  ///< empty: select_instruction_set()
};

/// Disparities of a rectified pair by semi-global matching (Hirschmueller 2008) of census
/// transforms (Zabih and Woodfill 1994). Costs are integers, so the result is the same for every
/// number of threads and instruction set. Throws Error when the sizes of the images differ, an
/// image is empty or too large, or an option is not allowed or wider than the image.
StereoMatch match_stereo(const GreyImage& left, const GreyImage& right,
                         const StereoOptions& options, const StereoRun& run = {});

/// Matches pairs one after the other. It keeps its memory, so that all but the first take less
/// time.
class StereoMatcher {
 public:
  /// Throws Error when an option is not allowed.
  explicit StereoMatcher(const StereoOptions& options);
  ~StereoMatcher();
  StereoMatcher(StereoMatcher&& other) noexcept;
  StereoMatcher& operator=(StereoMatcher&& other) noexcept;
  StereoMatcher(const StereoMatcher&) = delete;
  StereoMatcher& operator=(const StereoMatcher&) = delete;

  /// The same as match_stereo(). Not for several threads at once.
  StereoMatch match(const GreyImage& left, const GreyImage& right, const StereoRun& run = {});

 private:
  struct Memory;
  StereoOptions options_;
  std::unique_ptr<Memory> memory_;
};

/// Throws Error as match_stereo() does.
void require_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>
#include <glidar/core/report.hpp>
#include <glidar/math/thread_pool.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Which pixels of a window are compared (Zabih and Woodfill 1994): each with the centre, or each
/// with the one on the other side of the centre.
enum class StereoCensus : std::uint8_t { window_9x9, window_7x7, symmetric_7x7 };

/// How the minimum between three summed costs is found: a V of equal slopes (equiangular), a
/// parabola, or the integer disparity.
enum class StereoSubpixel : std::uint8_t { v_shape, parabola, none };

/// Options of match_stereo().
struct StereoOptions {
  std::uint32_t min_disparity_px = 0;
  std::uint32_t disparities = 128;  ///< searched, from min_disparity_px
  StereoCensus census = StereoCensus::window_7x7;
  std::uint32_t box_px = 5;  ///< odd side of the window over which costs are summed
  std::uint32_t paths = 8;   ///< 4 or 8
  double p1 = 4.0;           ///< cost of a step of 1 px along a path, bits per pixel of the box
  double p2 = 16.0;          ///< cost of a larger step, bits per pixel of the box; at least p1
  StereoSubpixel subpixel = StereoSubpixel::v_shape;
  double a_factor = 0.04;                 ///< px; adds a_factor sin(2 pi fraction)
  std::uint32_t uniqueness_percent = 15;  ///< 0: no test
  std::uint32_t left_right_px = 1;        ///< greatest difference of both views
  bool has_left_right_test = true;
  double min_texture = 0.5;  ///< mean grey-level step between neighbours; 0: no test
  std::uint32_t saturation_level =
      0;  ///< grey level from which pixels are saturated; 0: the greatest of the pixel type
  std::uint32_t steps_per_px = 32;  ///< disparities are multiples of 1 / this; 0: not rounded
};

/// Shows every option with its bounds and default to a visitor.
void describe(StereoOptions& options, FieldVisitor& visitor);

/// Number of bits of a census, and pixels from its centre to its edge.
std::uint32_t census_bits(StereoCensus census);
std::uint32_t census_radius_px(StereoCensus census);

/// Columns from the centre of a census window plus box to its edge.
std::uint32_t window_radius_px(const StereoOptions& options);

/// The penalties times the area of the box, rounded: the integers that path costs use.
std::int32_t penalty_p1(const StereoOptions& options);
std::int32_t penalty_p2(const StereoOptions& options);

/// Throws Error naming the first option that is not allowed.
void validate(const StereoOptions& options);

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

/// A rectified pair of cameras.
struct StereoGeometry {
  double focal_length_px = 0.0;
  double baseline_m = 0.0;
  double column_offset_px = 0.0;  ///< principal column of the right minus that of the left image
  double depth_unit_m = 0.001;    ///< depths are multiples of this; 0: not rounded
};

/// Shows every value with its bounds and default to a visitor.
void describe(StereoGeometry& geometry, FieldVisitor& visitor);

/// Depth along the boresight of the left camera, z = f b / (disparity + offset), metres: one for
/// each pixel, NaN where there is no disparity or its sum with the offset is not above 0. Throws
/// Error when a value of the geometry is not allowed.
std::vector<float> stereo_depth_m(const StereoMatch& match, const StereoGeometry& geometry);

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

/// A rectified pair.
struct StereoPair {
  GreyImage left;
  GreyImage right;
};

inline constexpr std::uint32_t kSampleFar_px = 12;   ///< disparity of the plane
inline constexpr std::uint32_t kSampleNear_px = 36;  ///< disparity of the disc before it

/// A generated pair of 320x200 pixels, to try the matcher: random dots on a plane and on a disc
/// before it, and on the plane a patch without dots and a saturated one. Every call returns the
/// same pair.
StereoPair sample_stereo_pair();

}  // namespace glidar

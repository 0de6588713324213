// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace glidar {

/// Depths along the boresight row by row from the top, as drivers of depth cameras report them: 16
/// bits, multiples of a unit, 0 for none. width x height.
struct DepthImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint16_t> depth = {};
};

class FieldVisitor;

// Each filter has the effect, the options and the defaults of the filter of librealsense 2 of the
// same name (doc/post-processing-filters.md there).

/// Blocks of magnitude x magnitude pixels become one: of up to 3 x 3 the median of their depths, of
/// larger ones the mean, rounded down. Both sides of the image become multiples of 4 by pixels
/// without depth.
struct DecimationFilter {
  static constexpr TypeInfo kType = {
      "decimation", "a block becomes one pixel: its median up to 3x3, else its mean",
      "librealsense"};
  std::uint32_t magnitude = 2;
};

/// Removes depths outside the interval.
struct ThresholdFilter {
  static constexpr TypeInfo kType = {"threshold", "removes depths outside an interval",
                                     "librealsense"};
  double min_m = 0.1;
  double max_m = 4.0;
};

/// Depths become disparities in units of 1/32 px: 32 f b / z, with the focal length of the image.
struct ToDisparity {
  static constexpr TypeInfo kType = {
      "to_disparity", "depths become disparities in 1/32 px, up to `to_depth`", "librealsense"};
  double baseline_m = 0.0;
};

/// Disparities become depths, rounded to the unit.
struct ToDepth {
  static constexpr TypeInfo kType = {"to_depth", "disparities become depths", "librealsense"};
};

/// The width of the holes that SpatialFilter fills along rows.
enum class HoleWidth : std::uint8_t { none, px_2, px_4, px_8, px_16, unlimited };

/// Edge-preserving smoothing along rows, then columns, in both directions: an exponential moving
/// average that restarts at steps of delta and more (Gastal and Oliveira, Domain Transform for
/// Edge-Aware Image and Video Processing, SIGGRAPH 2011).
struct SpatialFilter {
  static constexpr TypeInfo kType = {"spatial", "smooths along rows and columns up to edges",
                                     "Gastal and Oliveira 2011; librealsense"};
  double alpha = 0.5;
  std::uint32_t delta = 20;
  std::uint32_t magnitude = 2;
  HoleWidth hole_filling = HoleWidth::none;
};

/// Exponential moving average over frames that restarts at changes of delta and more. A pixel
/// without depth keeps its last one if enough of the previous frames had one there.
struct TemporalFilter {
  static constexpr TypeInfo kType = {"temporal", "smooths over frames, and fills holes from them",
                                     "librealsense"};
  double alpha = 0.4;
  std::uint32_t delta = 20;
  std::uint32_t persistence = 3;
};

/// Which neighbour fills a hole.
enum class HoleSource : std::uint8_t { left, farthest, nearest };

/// Fills every hole from its neighbours on the left, above and below.
struct HoleFillingFilter {
  static constexpr TypeInfo kType = {"hole_filling", "fills holes from a neighbour",
                                     "librealsense"};
  HoleSource source = HoleSource::farthest;
};

using DepthFilter = std::variant<DecimationFilter, ThresholdFilter, ToDisparity, ToDepth,
                                 SpatialFilter, TemporalFilter, HoleFillingFilter>;

/// Maximum number of filters in a list.
inline constexpr std::size_t kMaxDepthFilters = 64;

/// Keys: `type` and those of the filter.
void describe(DepthFilter& filter, FieldVisitor& visitor);

void describe(DecimationFilter& filter, FieldVisitor& visitor);
void describe(ThresholdFilter& filter, FieldVisitor& visitor);
void describe(ToDisparity& filter, FieldVisitor& visitor);
void describe(ToDepth& filter, FieldVisitor& visitor);
void describe(SpatialFilter& filter, FieldVisitor& visitor);
void describe(TemporalFilter& filter, FieldVisitor& visitor);
void describe(HoleFillingFilter& filter, FieldVisitor& visitor);

/// Throws Error naming the first option that is not allowed, or the first filter at the wrong
/// place: decimation and threshold take depths, and a list ends with depths.
void validate(std::span<const DepthFilter> filters);

/// The order that librealsense recommends, with defaults: decimation, to_disparity, spatial,
/// temporal, to_depth, hole_filling. With a baseline of 0, without the two conversions.
std::vector<DepthFilter> recommended_depth_filters(double baseline_m);

/// What filters need to know of the camera.
struct DepthFilterCamera {
  double focal_length_px = 0.0;  ///< along rows, of the images before the filters; for to_disparity
  double unit_m = 0.001;         ///< of depths
};

/// Keys: the values with their bounds and defaults.
void describe(DepthFilterCamera& camera, FieldVisitor& visitor);

/// Applies filters in their order to the images of one camera, one after the other. Arithmetic is
/// that of librealsense (single precision), so the result has its bytes. Only the temporal filter
/// keeps a state.
class DepthFilterChain {
 public:
  /// Throws Error as validate() does, or when to_disparity lacks the focal length.
  DepthFilterChain(std::span<const DepthFilter> filters, const DepthFilterCamera& camera);
  ~DepthFilterChain();
  DepthFilterChain(DepthFilterChain&&) noexcept;
  DepthFilterChain& operator=(DepthFilterChain&&) noexcept;
  DepthFilterChain(const DepthFilterChain&) = delete;
  DepthFilterChain& operator=(const DepthFilterChain&) = delete;

  /// The next image. Another size than that of the image before clears the state. Throws Error
  /// when the image is empty or has not width x height depths.
  DepthImage apply(const DepthImage& image);
  /// Forgets all images: the next one is the first.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The camera of the filtered images: the focal length is divided by the decimation.
DepthFilterCamera filtered_camera(std::span<const DepthFilter> filters, DepthFilterCamera camera);

}  // namespace glidar

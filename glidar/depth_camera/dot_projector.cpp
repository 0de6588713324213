// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/dot_projector.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/random.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr NumberRule kPatternAngle = {0.1, 170.0, false, "degrees from 0.1 to 170"};
constexpr NumberRule kOrigin = {-10.0, 10.0, false, "metres from -10 to 10"};
constexpr double kTexelsPerSigma = 2.0;  // linear interpolation is then off by at most 3 %
constexpr double kDotReach = 4.0;        // in standard deviations: 3e-4 of the peak

/// tan(angle / 2).
double half_extent(double angle_rad) {
  const SineCosine half = sincos_turns(angle_rad / (4.0 * std::numbers::pi));
  return half.sine / half.cosine;
}

double dot_sigma(const DotProjector& projector) {
  static const double kWidthOverSigma = 2.0 * std::sqrt(2.0 * std::numbers::ln2);
  return projector.dot_width_rad / kWidthOverSigma;
}

/// Finds whether a point is near an earlier one, with at most one point in each cell.
class NeighbourGrid {
 public:
  NeighbourGrid(double half_x, double half_y, double distance)
      : half_x_(half_x),
        half_y_(half_y),
        distance_(distance),
        cell_(distance / std::numbers::sqrt2),
        cols_(static_cast<std::int64_t>(2.0 * half_x / cell_) + 1),
        rows_(static_cast<std::int64_t>(2.0 * half_y / cell_) + 1),
        point_(static_cast<std::size_t>(cols_ * rows_), Eigen::Vector2d::Constant(1e9)) {}

  /// Adds the point unless another one is nearer than the distance.
  bool add(const Eigen::Vector2d& point) {
    const auto column = static_cast<std::int64_t>((point.x() + half_x_) / cell_);
    const auto row = static_cast<std::int64_t>((point.y() + half_y_) / cell_);
    for (std::int64_t r = std::max<std::int64_t>(row - 2, 0); r <= std::min(row + 2, rows_ - 1);
         ++r) {
      if (is_near(point, r, column)) return false;
    }
    at(row, column) = point;
    return true;
  }

 private:
  [[nodiscard]] bool is_near(const Eigen::Vector2d& point, std::int64_t row, std::int64_t column) {
    const std::int64_t last = std::min(column + 2, cols_ - 1);
    for (std::int64_t c = std::max<std::int64_t>(column - 2, 0); c <= last; ++c) {
      if ((at(row, c) - point).squaredNorm() < distance_ * distance_) return true;
    }
    return false;
  }
  Eigen::Vector2d& at(std::int64_t row, std::int64_t column) {
    return point_[static_cast<std::size_t>(row * cols_ + column)];
  }

  double half_x_;
  double half_y_;
  double distance_;
  double cell_;
  std::int64_t cols_;
  std::int64_t rows_;
  std::vector<Eigen::Vector2d> point_;
};

/// An empty map of the projector's field with about this many texels per unit.
IntensityMap empty_map(const DotProjector& projector, double texels_per_unit) {
  const double half_x = half_extent(projector.fov_x_rad);
  const double half_y = half_extent(projector.fov_y_rad);
  const double width = std::ceil(2.0 * half_x * texels_per_unit);
  const double height = std::ceil(2.0 * half_y * texels_per_unit);
  if (width * height > static_cast<double>(kMaxPatternTexels) || width < 2.0 || height < 2.0) {
    throw Error({.where = "projector, dot_width_deg",
                 .found = "the pattern needs " + number_text(width) + " x " + number_text(height) +
                          " texels",
                 .allowed = "2 x 2 to 2^26 texels, two for each standard deviation of a dot",
                 .remedy = "use wider dots, or a narrower pattern"});
  }
  IntensityMap map;
  map.width = static_cast<std::uint32_t>(width);
  map.height = static_cast<std::uint32_t>(height);
  map.left = -half_x;
  map.top = -half_y;
  map.texels_per_x = width / (2.0 * half_x);
  map.texels_per_y = height / (2.0 * half_y);
  map.w_per_sr.assign(std::size_t{map.width} * map.height, 0.0F);
  return map;
}

double texel_x(const IntensityMap& map, std::size_t column) {
  return map.left + (static_cast<double>(column) + 0.5) / map.texels_per_x;
}
double texel_y(const IntensityMap& map, std::size_t row) {
  return map.top + (static_cast<double>(row) + 0.5) / map.texels_per_y;
}

/// Values of a dot's Gaussian at the texels of a row or column that it reaches.
struct DotProfile {
  std::size_t begin = 0;
  std::vector<double> value;

  /// `edge` is the coordinate where texel 0 begins.
  DotProfile(double centre, double sigma, double edge, double texels_per_unit, std::uint32_t size) {
    const double middle = (centre - edge) * texels_per_unit - 0.5;
    const double reach = kDotReach * sigma * texels_per_unit;
    begin = static_cast<std::size_t>(std::max(0.0, std::ceil(middle - reach)));
    const double last = std::min(std::floor(middle + reach), size - 1.0);
    for (double texel = static_cast<double>(begin); texel <= last; texel += 1.0) {
      const double x = (texel - middle) / (sigma * texels_per_unit);
      value.push_back(portable_exp(-0.5 * x * x));
    }
  }
};

void add_dot(const Dot& dot, double sigma, IntensityMap& map) {
  const DotProfile columns(dot.centre.x(), sigma, map.left, map.texels_per_x, map.width);
  const DotProfile rows(dot.centre.y(), sigma, map.top, map.texels_per_y, map.height);
  for (std::size_t row = 0; row < rows.value.size(); ++row) {
    float* const texel = map.w_per_sr.data() + (rows.begin + row) * map.width + columns.begin;
    const double brightness = dot.brightness * rows.value[row];
    for (std::size_t column = 0; column < columns.value.size(); ++column) {
      texel[column] += static_cast<float>(brightness * columns.value[column]);
    }
  }
}

IntensityMap map_of_dots(const DotProjector& projector) {
  const double sigma = dot_sigma(projector);
  IntensityMap map = empty_map(projector, kTexelsPerSigma / sigma);
  for (const Dot& dot : place_dots(projector)) add_dot(dot, sigma, map);
  return map;
}

IntensityMap map_of_picture(const DotProjector& projector) {
  const GreyImage& picture = projector.pattern;
  IntensityMap map;
  map.width = picture.width;
  map.height = picture.height;
  map.left = -half_extent(projector.fov_x_rad);
  map.top = -half_extent(projector.fov_y_rad);
  map.texels_per_x = picture.width / (-2.0 * map.left);
  map.texels_per_y = picture.height / (-2.0 * map.top);
  map.w_per_sr.assign(picture.level.begin(), picture.level.end());
  return map;
}

/// Scales the map to the power.
void normalise(double power_w, IntensityMap& map) {
  const double area = 1.0 / (map.texels_per_x * map.texels_per_y);
  double sum = 0.0;
  for (std::size_t row = 0; row < map.height; ++row) {
    const double y = texel_y(map, row);
    double row_sum = 0.0;
    for (std::size_t column = 0; column < map.width; ++column) {
      const double x = texel_x(map, column);
      const double r2 = x * x + y * y + 1.0;
      row_sum += map.w_per_sr[row * map.width + column] / (r2 * std::sqrt(r2));
    }
    sum += row_sum;
  }
  if (!(sum > 0.0)) {
    throw Error({.where = "projector",
                 .found = "a pattern without light",
                 .allowed = "a picture with levels above 0, or at least one dot",
                 .remedy = ""});
  }
  const auto scale = static_cast<float>(power_w / (sum * area));
  for (float& intensity : map.w_per_sr) intensity *= scale;
}

}  // namespace

void describe(DotProjector& projector, FieldVisitor& visitor) {
  Eigen::Vector3d origin_m = projector.origin_m;
  if (visitor.vector({"origin_m", "its position in the frame of the left camera", kUnitMetre, false,
                      "[0, 0, 0]"},
                     kOrigin, true, origin_m)) {
    projector.origin_m = origin_m;
  }
  visitor.number({"power_w", "optical power of the whole pattern, W"}, kLightPowerRule,
                 projector.power_w);
  visitor.number({"fov_x_deg", "angle that the pattern covers along the width", kUnitDegree},
                 kPatternAngle, projector.fov_x_rad);
  visitor.number({"fov_y_deg", "the same along the height", kUnitDegree}, kPatternAngle,
                 projector.fov_y_rad);
  visitor.whole_number({"dots", "number of dots of the generated pattern"}, {1, 1000000},
                       projector.dots);
  visitor.number({"dot_width_deg", "full width of a dot at half maximum", kUnitDegree},
                 {0.01, 10.0, false, "degrees from 0.01 to 10"}, projector.dot_width_rad);
  visitor.number({"dot_contrast", "standard deviation over mean of the dots' brightness"},
                 kZeroToOne, projector.dot_contrast);
  visitor.whole_number({"pattern_seed", "of the generated pattern"}, {}, projector.pattern_seed);
  if (!visitor.is_writing() || !projector.picture.empty()) {
    visitor.path({"picture",
                  "grey PNG in place of generated dots; levels are linear intensities, and the "
                  "picture covers `fov_x_deg` x `fov_y_deg`",
                  kNoUnit, false, "generated dots"},
                 projector.picture);
  }
  visitor.number({"speckle_contrast",
                  "standard deviation over mean of the light that speckle changes in every frame"},
                 kZeroToOne, projector.speckle_contrast);
}

std::vector<Dot> place_dots(const DotProjector& projector) {
  constexpr double kSpacing = 0.7;                // of the mean; jamming is at 0.834
  constexpr std::uint32_t kAttemptsPerDot = 100;  // 11 are needed on average
  const double half_x = half_extent(projector.fov_x_rad);
  const double half_y = half_extent(projector.fov_y_rad);
  const double mean_spacing = std::sqrt(4.0 * half_x * half_y / projector.dots);
  NeighbourGrid grid(half_x, half_y, kSpacing * mean_spacing);
  std::vector<Dot> dots;
  const std::uint32_t attempts = kAttemptsPerDot * projector.dots;
  for (std::uint32_t attempt = 0; attempt < attempts && dots.size() < projector.dots; ++attempt) {
    RngKey key = {.seed = projector.pattern_seed,
                  .frame = kAllFrames,
                  .beam = attempt,
                  .purpose = Purpose::dot_pattern};
    const RandomWords words = random_words(key);
    key.block = 1;
    const Eigen::Vector2d place((2.0 * uniform(words[0]) - 1.0) * half_x,
                                (2.0 * uniform(words[1]) - 1.0) * half_y);
    if (grid.add(place)) dots.push_back({place, sample_gamma(projector.dot_contrast, key)});
  }
  return dots;
}

IntensityMap make_intensity_map(const DotProjector& projector) {
  IntensityMap map =
      projector.pattern.level.empty() ? map_of_dots(projector) : map_of_picture(projector);
  normalise(projector.power_w, map);
  return map;
}

}  // namespace glidar

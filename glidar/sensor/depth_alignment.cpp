// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_alignment.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace glidar {
namespace {

constexpr double kMaxUnits = std::numeric_limits<std::uint16_t>::max();

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// Where the rays through these places cross the plane z = 1; NaN for none. Places are at whole
/// numbers plus the offset.
std::vector<Eigen::Vector2d> plane_points(const Pinhole& pinhole, std::uint32_t columns,
                                          std::uint32_t rows, double offset) {
  const PinholeProjection projection(pinhole);
  std::vector<Eigen::Vector2d> points;
  points.reserve(std::size_t{columns} * rows);
  for (std::uint32_t v = 0; v < rows; ++v) {
    for (std::uint32_t u = 0; u < columns; ++u) {
      const Eigen::Vector3d ray = projection.ray_through({u + offset, v + offset});
      points.push_back(ray.z() > 0.0 ? Eigen::Vector2d(ray.head<2>() / ray.z())
                                     : Eigen::Vector2d::Constant(std::nan("")));
    }
  }
  return points;
}

/// The pixels from one rounded coordinate to another, within the image; false: none.
bool clip(double a, double b, std::uint32_t size, std::uint32_t& first, std::uint32_t& last) {
  const double low = std::floor(std::min(a, b) + 0.5);
  const double high = std::floor(std::max(a, b) + 0.5);
  if (!(high >= 0.0 && low < size)) return false;
  first = static_cast<std::uint32_t>(std::max(low, 0.0));
  last = static_cast<std::uint32_t>(std::min(high, size - 1.0));
  return true;
}

const DepthAlignment& checked(const DepthAlignment& alignment) {
  make_beams(alignment.colour);
  make_beams(alignment.depth);
  require_number(accepts(kAboveZero, alignment.unit_m), "depth alignment, unit_m", alignment.unit_m,
                 kAboveZero.allowed);
  return alignment;
}

}  // namespace

void describe(DepthAlignment& alignment, FieldVisitor& visitor) {
  visit_object(visitor, {"depth", "the depth camera, as `optics` of a sensor", kNoUnit, kRequired},
               alignment.depth);
  visit_object(visitor,
               {"colour", "the colour camera, as `optics` of a sensor", kNoUnit, kRequired},
               alignment.colour);
  visit_pose(visitor,
             {"colour_from_depth", "the depth camera in the optical frame of the colour camera",
              kNoUnit, kRequired},
             true, alignment.colour_from_depth);
  visitor.number({"depth_unit_mm", "unit of depths", kUnitMillimetre}, kAboveZero,
                 alignment.unit_m);
  visitor.boolean({"keeps_depth",
                   "`true`: depths stay along the boresight of the depth camera, as in "
                   "librealsense; `false`: they are along that of the colour camera"},
                  alignment.keeps_depth);
}

DepthAligner::DepthAligner(const DepthAlignment& alignment)
    : alignment_(checked(alignment)), colour_(alignment.colour) {
  const PinholeIntrinsics& k = alignment.depth.intrinsics;
  corners_ = plane_points(alignment.depth, k.width + 1, k.height + 1, -0.5);
  centres_ = plane_points(alignment.depth, k.width, k.height, 0.0);
}

bool DepthAligner::find_square(std::size_t pixel, double depth_m, Square& square) const {
  const std::size_t width = alignment_.depth.intrinsics.width;
  const std::size_t corner = pixel / width * (width + 1) + pixel % width;
  const auto in_colour = [&](const Eigen::Vector2d& plane) -> Eigen::Vector3d {
    return alignment_.colour_from_depth *
           Eigen::Vector3d(plane.x() * depth_m, plane.y() * depth_m, depth_m);
  };
  const auto upper_left = colour_.pixel_of(in_colour(corners_[corner]));
  const auto lower_right = colour_.pixel_of(in_colour(corners_[corner + width + 2]));
  if (!upper_left || !lower_right) return false;
  const PinholeIntrinsics& k = alignment_.colour.intrinsics;
  if (!clip(upper_left->x(), lower_right->x(), k.width, square.first[0], square.last[0]) ||
      !clip(upper_left->y(), lower_right->y(), k.height, square.first[1], square.last[1])) {
    return false;
  }
  square.depth_m = in_colour(centres_[pixel]).z();
  return square.depth_m > 0.0;
}

void DepthAligner::cover(const Square& square, std::size_t pixel, std::uint16_t depth,
                         AlignedDepth& aligned) const {
  for (std::uint32_t y = square.first[1]; y <= square.last[1]; ++y) {
    for (std::uint32_t x = square.first[0]; x <= square.last[0]; ++x) {
      const std::size_t i = std::size_t{y} * aligned.image.width + x;
      if (aligned.image.depth[i] != 0 && aligned.image.depth[i] <= depth) continue;
      aligned.image.depth[i] = depth;
      aligned.source[i] = static_cast<std::uint32_t>(pixel);
    }
  }
}

AlignedDepth DepthAligner::align(const DepthImage& image) const {
  const PinholeIntrinsics& from = alignment_.depth.intrinsics;
  const PinholeIntrinsics& to = alignment_.colour.intrinsics;
  if (image.width != from.width || image.height != from.height ||
      image.depth.size() != centres_.size()) {
    throw Error({"depth image", "has " + size_text(image.width, image.height) + " pixels",
                 size_text(from.width, from.height) + ", as the depth camera", ""});
  }
  AlignedDepth aligned;
  aligned.image = {to.width, to.height,
                   std::vector<std::uint16_t>(std::size_t{to.width} * to.height, 0)};
  aligned.source.assign(aligned.image.depth.size(), kNoSource);
  Square square;
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    std::uint16_t depth = image.depth[pixel];
    if (depth == 0 || !find_square(pixel, depth * alignment_.unit_m, square)) continue;
    if (!alignment_.keeps_depth) {
      const double units = std::floor(square.depth_m / alignment_.unit_m + 0.5);
      if (!(units >= 1.0 && units <= kMaxUnits)) continue;
      depth = static_cast<std::uint16_t>(units);
    }
    cover(square, pixel, depth, aligned);
  }
  return aligned;
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/common/hit_rule.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/double_double.hpp>
#include <glidar/render/common/hit_arithmetic.hpp>

#include <limits>

namespace glidar {
namespace {

std::string text_of(const Eigen::Vector3d& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

bool is_origin_allowed(const Eigen::Vector3d& origin) {
  const Eigen::Array3d size = origin.array().abs();
  return (size <= kMaxHitOrigin).all();  // false for NaN
}

bool is_direction_allowed(const Eigen::Vector3d& direction) {
  if (!direction.allFinite()) return false;
  const double largest = direction.cwiseAbs().maxCoeff();
  return largest >= kMinHitDirection && largest <= kMaxHitDirection;
}

/// The axis along which the direction's component is the largest, the lowest of equal ones.
unsigned main_axis(const Eigen::Vector3d& direction) {
  const Eigen::Array3d size = direction.array().abs();
  unsigned axis = 0;
  if (size[1] > size[axis]) axis = 1;
  if (size[2] > size[axis]) axis = 2;
  return axis;
}

}  // namespace

bool is_within_hit_limits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return is_origin_allowed(origin) && is_direction_allowed(direction);
}

void check_hit_limits(const std::string& where, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction) {
  if (!is_origin_allowed(origin)) {
    throw Error({where, "its origin is " + text_of(origin) + " in the frame of a mesh",
                 "finite coordinates up to " + number_text(kMaxHitOrigin),
                 "place the sensor and the objects nearer to each other"});
  }
  if (!is_direction_allowed(direction)) {
    throw Error({where, "its direction is " + text_of(direction) + " in the frame of a mesh",
                 "finite numbers, the largest from " + number_text(kMinHitDirection) + " to " +
                     number_text(kMaxHitDirection),
                 "make the direction a unit vector"});
  }
}

HitRay make_hit_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const unsigned z = main_axis(direction);
  const unsigned x = (z + 1) % 3;
  const unsigned y = (z + 2) % 3;
  HitRay ray{
      {origin.x(), origin.y(), origin.z()},
      {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z)},
      direction[x] / direction[z],
      direction[y] / direction[z],
      direction[z]};
  if (!is_within_hit_limits(origin, direction)) {
    ray.along = std::numeric_limits<double>::quiet_NaN();  // no distance is positive
  }
  return ray;
}

double hit_distance(const HitRay& ray, const HitTriangle& triangle) {
  return hit_arithmetic::distance<ExactProduct>(ray, triangle);
}

}  // namespace glidar

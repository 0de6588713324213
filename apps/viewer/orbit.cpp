// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/orbit.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace glidar::app {
namespace {

Eigen::Vector3d to_eye(const Orbit& orbit) {
  return {portable_cos(orbit.pitch_rad) * portable_cos(orbit.yaw_rad),
          portable_cos(orbit.pitch_rad) * portable_sin(orbit.yaw_rad),
          portable_sin(orbit.pitch_rad)};
}

double half_height() {
  return portable_tan(kOrbitFov_rad / 2.0);
}

}  // namespace

void turn(Orbit& orbit, const Eigen::Vector2d& drag) {
  constexpr double kSteepest =
      std::numbers::pi / 2.0 - 1e-3;  // the view direction must not be vertical
  orbit.yaw_rad =
      std::remainder(orbit.yaw_rad - std::numbers::pi * drag.x(), 2.0 * std::numbers::pi);
  orbit.pitch_rad =
      std::clamp(orbit.pitch_rad + std::numbers::pi * drag.y(), -kSteepest, kSteepest);
}

void pan(Orbit& orbit, const Eigen::Vector2d& drag) {
  const double height_m = 2.0 * half_height() * orbit.distance_m;
  const Eigen::Matrix3d axes = anchor_from_eye(orbit).linear();
  orbit.pivot_m -= height_m * (drag.x() * axes.col(0) + drag.y() * axes.col(1));
}

void zoom(Orbit& orbit, double steps) {
  constexpr double kNearest_m = 1e-6;
  constexpr double kFarthest_m = 1e9;
  orbit.distance_m =
      std::clamp(orbit.distance_m * portable_pow(0.9, steps), kNearest_m, kFarthest_m);
}

Pose anchor_from_eye(const Orbit& orbit) {
  return look_at(orbit.pivot_m + orbit.distance_m * to_eye(orbit), orbit.pivot_m,
                 Eigen::Vector3d::UnitZ());
}

Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect) {
  constexpr double kNear = 1e-3;  // of the distance
  constexpr double kFar = 1e3;
  const double near_m = kNear * orbit.distance_m;
  const double far_m = kFar * orbit.distance_m;
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = 1.0 / (aspect * half_height());
  clip_from_eye(1, 1) = -1.0 / half_height();
  clip_from_eye(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_from_eye(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_from_eye(3, 2) = 1.0;
  return (clip_from_eye * anchor_from_eye(orbit).inverse().matrix()).cast<float>();
}

std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach) {
  const Pose eye_from_anchor = anchor_from_eye(orbit).inverse();
  std::optional<std::size_t> best;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d seen = eye_from_anchor * points[i].cast<double>();
    if (!(seen.z() > 0.0 && seen.z() < nearest_m)) continue;
    const Eigen::Vector2d at(seen.x() / seen.z() / half_height(),
                             -seen.y() / seen.z() / half_height());
    if ((at - place).norm() > 2.0 * reach) continue;
    best = i;
    nearest_m = seen.z();
  }
  return best;
}

namespace {

constexpr double kMargin = 1.1;  // free space around framed objects

/// The distance at which a sphere fits into this half angle.
double distance_to_see(double radius_m, double half_angle_rad) {
  return kMargin * radius_m / portable_sin(half_angle_rad);
}

bool contains(const Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect) {
  const Pose eye_from_anchor = anchor_from_eye(orbit).inverse();
  const double half_height = portable_tan(kOrbitFov_rad / 2.0);
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d seen = eye_from_anchor * point;
    const double reach = half_height * seen.z();
    return std::abs(seen.x()) <= aspect * reach && std::abs(seen.y()) <= reach;
  });
}

}  // namespace

Sphere sphere_around(std::span<const Eigen::Vector3d> corners_m) {
  Sphere sphere;
  if (corners_m.empty()) return sphere;
  for (const Eigen::Vector3d& corner : corners_m) sphere.middle_m += corner;
  sphere.middle_m /= static_cast<double>(corners_m.size());
  for (const Eigen::Vector3d& corner : corners_m) {
    sphere.radius_m = std::max(sphere.radius_m, (corner - sphere.middle_m).norm());
  }
  return sphere;
}

void frame_sphere(Orbit& orbit, const Sphere& anchored, double aspect) {
  constexpr double kMinRadius_m = 1e-6;
  const double half_rad =
      portable_atan(portable_tan(kOrbitFov_rad / 2.0) * std::clamp(aspect, 1e-3, 1.0));
  orbit.pivot_m = anchored.middle_m;
  orbit.distance_m = distance_to_see(std::max(anchored.radius_m, kMinRadius_m), half_rad);
}

void zoom_out_to(Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect) {
  constexpr int kMaxSteps = 100;  // 0.9^-100: 38,000 times as far
  for (int i = 0; i < kMaxSteps && !contains(orbit, points, aspect); ++i) zoom(orbit, -1.0);
}

Orbit view_of_all(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& sensor_m, double aspect) {
  const double size_m = box.isEmpty() ? 1.0 : box.diagonal().norm();
  const bool is_among = !box.isEmpty() && box.contains(sensor_m);
  Orbit orbit{.pivot_m = 0.45 * sensor_m,
              .yaw_rad = portable_atan2(sensor_m.y(), sensor_m.x()) + 0.9,
              .pitch_rad = 0.45,
              .distance_m = is_among ? 0.5 * size_m : 1.8 * std::max(size_m, sensor_m.norm())};
  std::vector<Eigen::Vector3d> ends_m = {sensor_m};
  for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
    ends_m.emplace_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  zoom_out_to(orbit, ends_m, aspect);
  return orbit;
}

std::optional<FieldOfView> field_of_view(const Beams& beams) {
  constexpr double kMinAhead = 0.1;     // cosine; wider images need no aiming
  constexpr double kMinTangent = 1e-3;  // narrower images cannot contain an object
  FieldOfView field{.axes = axes_of(beams)};
  for (const Eigen::Vector3d& direction : beams.directions) {
    if (std::isnan(direction.x())) continue;
    const double ahead = direction.dot(field.axes.ahead);
    if (ahead < kMinAhead) return std::nullopt;
    const double left = direction.dot(field.axes.left) / ahead;
    const double up = direction.dot(field.axes.up) / ahead;
    field.left = std::max(field.left, left);
    field.right = std::max(field.right, -left);
    field.up = std::max(field.up, up);
    field.down = std::max(field.down, -up);
  }
  const double min_tangent = std::min({field.left, field.right, field.up, field.down});
  return min_tangent < kMinTangent ? std::nullopt : std::optional(field);
}

Visibility visibility(const FieldOfView& field, const Pose& world_from_sensor,
                      std::span<const Eigen::Vector3d> corners_m) {
  const Pose sensor_from_world = world_from_sensor.inverse();
  std::array<std::size_t, 5> beyond{};  // each edge, and behind the sensor
  for (const Eigen::Vector3d& corner : corners_m) {
    const Eigen::Vector3d at = sensor_from_world * corner;
    const double ahead = at.dot(field.axes.ahead);
    const double left = at.dot(field.axes.left);
    const double up = at.dot(field.axes.up);
    beyond[0] += left > field.left * ahead ? 1 : 0;
    beyond[1] += -left > field.right * ahead ? 1 : 0;
    beyond[2] += up > field.up * ahead ? 1 : 0;
    beyond[3] += -up > field.down * ahead ? 1 : 0;
    beyond[4] += ahead <= 0.0 ? 1 : 0;
  }
  const std::size_t max_beyond = *std::max_element(beyond.begin(), beyond.end());
  if (max_beyond == 0) return Visibility::inside;
  return max_beyond == corners_m.size() ? Visibility::outside : Visibility::partly;
}

std::optional<Pose> aimed_at(const FieldOfView& field, const Pose& world_from_sensor,
                             const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way_m = point_m - world_from_sensor.translation();
  if (way_m.norm() == 0.0) return std::nullopt;
  const Eigen::Vector3d ahead = world_from_sensor.linear() * field.axes.ahead;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(ahead, way_m);
  return make_pose(world_from_sensor.translation(),
                   turn * Eigen::Quaterniond(world_from_sensor.linear()));
}

std::optional<Pose> pose_to_show(const FieldOfView& field, const Pose& world_from_sensor,
                                 std::span<const Eigen::Vector3d> corners_m) {
  const Visibility now = visibility(field, world_from_sensor, corners_m);
  const Sphere sphere = sphere_around(corners_m);
  const Eigen::Vector3d way_m = sphere.middle_m - world_from_sensor.translation();
  const bool is_among = way_m.norm() <= sphere.radius_m;
  if (now == Visibility::inside || (is_among && now == Visibility::partly)) return std::nullopt;
  std::optional<Pose> pose = aimed_at(field, world_from_sensor, sphere.middle_m);
  if (!pose || is_among || visibility(field, *pose, corners_m) == Visibility::inside) return pose;
  const double tangent = std::min({field.left, field.right, field.up, field.down});
  const double distance_m = distance_to_see(sphere.radius_m, portable_atan(tangent));
  pose->translation() = sphere.middle_m - distance_m * way_m.normalized();
  return pose;
}

}  // namespace glidar::app

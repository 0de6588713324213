// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/view_placement.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace glidar {
namespace {

/// Wider cones are limited to this one: from nearer, the perspective distortion is extreme.
constexpr double kMaxHalfAngle_rad = std::numbers::pi / 3.0;

/// Minimum distance of the camera from the nearest vertex and from the scene's box, as a fraction
/// of the scene's half diagonal. It matters for shapes that are lines or points along the
/// boresight, and for wide views.
constexpr double kMinGap = 0.02;

[[noreturn]] void refuse_framing(std::string found, std::string remedy) {
  throw Error(
      {.where = "framing the scene", .found = std::move(found), .remedy = std::move(remedy)});
}

/// A rectangle in the plane z = 1 of the camera that is completely in the image.
struct Window {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

/// Calls visit(vertex, world frame) once for every vertex of the instance's triangles.
template <typename Visit>
void visit_corners(const Instance& instance, const Mesh& mesh, const Visit& visit) {
  std::vector<std::uint8_t> is_used(mesh.positions_m.size(), 0);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) is_used[corner] = 1;
  }
  for (std::uint32_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] == 0) continue;
    visit(instance.world_from_object * (instance.scale * vertex_m(mesh, i)));
  }
}

template <typename Visit>
void for_each_corner(const Scene& scene, const Visit& visit) {
  for (const Instance& instance : scene.instances) {
    visit_corners(instance, scene.meshes[instance.mesh], visit);
  }
}

/// The edges of the outermost pixels, not their centres.
Window window_of(const PinholeIntrinsics& k) {
  const double edge = k.pixel_centre - 0.5;
  return {{(edge - k.cx) / k.fx, (edge - k.cy) / k.fy},
          {(k.width + edge - k.cx) / k.fx, (k.height + edge - k.cy) / k.fy}};
}

/// The rectangle inside the beams at the image's border; empty if one is missing or is more than 80
/// degrees from the boresight.
std::optional<Window> window_of_border(const Beams& beams) {
  constexpr double kMinForward = 0.17;  // cosine of 80 degrees
  Window window{{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
  const std::uint32_t last_row = beams.rows - 1;
  const std::uint32_t last_col = beams.cols - 1;
  for (std::uint32_t row = 0; row < beams.rows; ++row) {
    const bool whole_row = row == 0 || row == last_row;
    for (std::uint32_t col = 0; col < beams.cols; col += whole_row ? 1 : std::max(1U, last_col)) {
      const Eigen::Vector3d& d = beams.directions[std::size_t{row} * beams.cols + col];
      if (!(d.z() > kMinForward)) return std::nullopt;
      const Eigen::Vector2d p = d.hnormalized();
      if (col == 0) window.low.x() = std::max(window.low.x(), p.x());
      if (col == last_col) window.high.x() = std::min(window.high.x(), p.x());
      if (row == 0) window.low.y() = std::max(window.low.y(), p.y());
      if (row == last_row) window.high.y() = std::min(window.high.y(), p.y());
    }
  }
  if (!(window.low.array() < window.high.array()).all()) return std::nullopt;
  return window;
}

std::optional<Window> find_window(const Beams& beams) {
  return beams.pinhole ? window_of(*beams.pinhole) : window_of_border(beams);
}

/// The positions from which the camera sees the scene: start + d * direction for d >= distance, in
/// the axes of the camera's initial pose.
struct CameraPath {
  Eigen::Vector3d start;
  Eigen::Vector3d direction;
  double distance;
};

/// The positions for an image that is a rectangle. With the camera at (s, t, -d), a vertex (X, Y,
/// Z) is inside if low (Z + d) <= (X - s, Y - t) <= high (Z + d). Both sides of each axis are
/// linear in d, so the minimum d follows directly from the extremes over all vertices.
CameraPath fit_window(const Window& window, const Scene& scene, const Pose& world_from_camera) {
  const Eigen::Vector2d middle = 0.5 * (window.low + window.high);
  const Eigen::Vector2d half = (1.0 - kFramingMargin) * 0.5 * (window.high - window.low);
  const Eigen::Vector2d low = middle - half;
  const Eigen::Vector2d high = middle + half;
  const Pose camera_from_world = world_from_camera.inverse();
  Eigen::Array2d above_low = Eigen::Array2d::Constant(kInfinity);    // min of X - low Z
  Eigen::Array2d above_high = Eigen::Array2d::Constant(-kInfinity);  // max of X - high Z
  double nearest = kInfinity;
  for_each_corner(scene, [&](const Eigen::Vector3d& world) {
    const Eigen::Vector3d p = camera_from_world * world;
    above_low = above_low.min(p.head<2>().array() - low.array() * p.z());
    above_high = above_high.max(p.head<2>().array() - high.array() * p.z());
    nearest = std::min(nearest, p.z());
  });
  const Eigen::Array2d needed = (above_high - above_low) / (high - low).array();
  const double gap = kMinGap * 0.5 * bounds(scene).diagonal().norm();
  const double distance = std::max(needed.maxCoeff(), gap - nearest);
  const Eigen::Array2d shift = 0.5 * (above_low + above_high);
  return {{shift.x(), shift.y(), 0.0}, {-middle.x(), -middle.y(), -1.0}, distance};
}

/// The same for an image that is a cone about `axis` (camera axes): no sideways shift.
CameraPath fit_cone(const Eigen::Vector3d& axis, double half_angle_rad, const Scene& scene,
                    const Pose& world_from_camera) {
  const double slope =
      (1.0 - kFramingMargin) * portable_tan(std::min(half_angle_rad, kMaxHalfAngle_rad));
  const Pose camera_from_world = world_from_camera.inverse();
  double distance = -kInfinity;
  double nearest = kInfinity;
  for_each_corner(scene, [&](const Eigen::Vector3d& world) {
    const Eigen::Vector3d p = camera_from_world * world;
    const double along = p.dot(axis);
    distance = std::max(distance, (p - along * axis).norm() / slope - along);
    nearest = std::min(nearest, along);
  });
  const double gap = kMinGap * 0.5 * bounds(scene).diagonal().norm();
  return {Eigen::Vector3d::Zero(), -axis, std::max(distance, gap - nearest)};
}

/// The first position of the path outside the scene's box, at the minimum distance from it.
Eigen::Vector3d outside_box(const CameraPath& path, const Scene& scene,
                            const Pose& world_from_camera) {
  Eigen::AlignedBox3d box = bounds(scene);
  const Eigen::Vector3d gap = Eigen::Vector3d::Constant(kMinGap * 0.5 * box.diagonal().norm());
  box = Eigen::AlignedBox3d(box.min() - gap, box.max() + gap);
  const Eigen::Vector3d start = world_from_camera * path.start;
  const Eigen::Vector3d direction = world_from_camera.linear() * path.direction;
  double distance = path.distance;
  if (box.contains(start + distance * direction)) {
    // The point is inside all slabs, so it leaves the box where it leaves the first of them.
    double leaving = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0.0) continue;
      const double side = direction[axis] > 0.0 ? box.max()[axis] : box.min()[axis];
      leaving = std::min(leaving, (side - start[axis]) / direction[axis]);
    }
    distance = std::max(distance, leaving);
  }
  return path.start + distance * path.direction;
}

bool is_beam(const Beams& beams, std::int64_t row, std::int64_t col) {
  if (row < 0 || col < 0 || row >= beams.rows || col >= beams.cols) return false;
  const auto index = static_cast<std::size_t>(row) * beams.cols + static_cast<std::size_t>(col);
  return !std::isnan(beams.directions[index].x());
}

/// The angle between `axis` and the nearest beam that has no beam on one of its sides.
double enclosed_angle_rad(const Beams& beams, const Eigen::Vector3d& axis) {
  double smallest = std::numbers::pi;
  for (std::int64_t row = 0; row < beams.rows; ++row) {
    for (std::int64_t col = 0; col < beams.cols; ++col) {
      if (!is_beam(beams, row, col)) continue;
      const bool inner = is_beam(beams, row - 1, col) && is_beam(beams, row + 1, col) &&
                         is_beam(beams, row, col - 1) && is_beam(beams, row, col + 1);
      if (inner) continue;
      const Eigen::Vector3d& d = beams.directions[static_cast<std::size_t>(row) * beams.cols +
                                                  static_cast<std::size_t>(col)];
      smallest = std::min(smallest, portable_atan2(axis.cross(d).norm(), axis.dot(d)));
    }
  }
  return smallest;
}

void require_camera(const Beams& beams) {
  if (beams.size() == 0 || !looks_along_z(beams)) {
    refuse_framing("the sensor is not a camera with boresight +z", "give the sensor's pose");
  }
}

}  // namespace

Pose fit_camera_to_scene(const Beams& beams, const Scene& scene,
                         const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up) {
  require_camera(beams);
  Eigen::AlignedBox3d box;
  for_each_corner(scene, [&](const Eigen::Vector3d& world) { box.extend(world); });
  if (box.isEmpty()) refuse_framing("the scene has no triangles", "load a model with triangles");
  if (!(box.diagonal().norm() > 0.0))
    refuse_framing("all vertices are one point", "give the sensor's pose");

  // Axes first, about the scene's centre; then the position in these axes.
  Pose pose = look_at(box.center() + from_direction, box.center(), up);
  pose.translation() = box.center();
  if (const std::optional<Window> window = find_window(beams)) {
    return pose * Eigen::Translation3d(outside_box(fit_window(*window, scene, pose), scene, pose));
  }
  const Eigen::Vector3d axis =
      beams.directions[std::size_t{beams.rows / 2} * beams.cols + beams.cols / 2];
  const double half_angle_rad = std::isnan(axis.x()) ? 0.0 : enclosed_angle_rad(beams, axis);
  if (!(half_angle_rad > 0.0)) {
    refuse_framing("the image has no area around its centre", "give the sensor's pose");
  }
  const CameraPath path = fit_cone(axis, half_angle_rad, scene, pose);
  return pose * Eigen::Translation3d(outside_box(path, scene, pose));
}

namespace {

/// Wider fans are limited to this one: from nearer, little of the scene would be in front of the
/// sensor.
constexpr double kMaxFan_rad = std::numbers::pi / 3.0;
constexpr double kLineHalfAngle_rad = std::numbers::pi / 6.0;  // distance: twice the radius
constexpr double kMinHalfAngle_rad = 1e-3;

struct Elevations {
  double middle_rad = 0.0;
  double half_rad = 0.0;
};

[[noreturn]] void refuse_placing(std::string found, std::string remedy) {
  throw Error({.where = "placing the sensor beside the scene",
               .found = std::move(found),
               .remedy = std::move(remedy)});
}

/// The elevations of the lowest and the highest beam, limited to the horizontal width.
Elevations elevations_of(const Beams& beams) {
  double low_rad = std::numbers::pi;
  double high_rad = -std::numbers::pi;
  double side_rad = 0.0;
  for (const Eigen::Vector3d& d : beams.directions) {
    if (std::isnan(d.x())) continue;
    const double elevation_rad = portable_asin(std::clamp(d.z(), -1.0, 1.0));
    low_rad = std::min(low_rad, elevation_rad);
    high_rad = std::max(high_rad, elevation_rad);
    side_rad = std::max(side_rad, std::abs(portable_atan2(d.y(), d.x())));
  }
  if (low_rad > high_rad) refuse_placing("the sensor has no beams", "");
  const double half_rad = 0.5 * (high_rad - low_rad);
  const double fan_rad = half_rad > kMinHalfAngle_rad ? half_rad : kLineHalfAngle_rad;
  return {0.5 * (low_rad + high_rad),
          std::min({fan_rad, std::max(side_rad, kMinHalfAngle_rad), kMaxFan_rad})};
}

}  // namespace

Pose place_lidar_beside(const Beams& beams, const Scene& scene,
                        const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up) {
  if (beams.size() == 0 || !beams.boresight.isApprox(Eigen::Vector3d::UnitX())) {
    refuse_placing("the sensor is not a LiDAR with boresight +x", "give the sensor's pose");
  }
  const Eigen::AlignedBox3d box = bounds(scene);
  if (box.isEmpty() || !(box.diagonal().norm() > 0.0)) {
    refuse_placing("the scene has no triangles or no extent", "give the sensor's pose");
  }
  const Elevations fan = elevations_of(beams);
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d side = from_direction - from_direction.dot(z) * z;
  if (!(side.norm() > 1e-9 * from_direction.norm())) {
    refuse_placing("the up vector is parallel to the line of sight", "choose another up vector");
  }
  const double distance_m = 0.5 * box.diagonal().norm() / portable_sin(fan.half_rad);
  const Eigen::Vector3d eye =
      box.center() + distance_m * (portable_cos(fan.middle_rad) * side.normalized() -
                                   portable_sin(fan.middle_rad) * z);
  return look_at(eye, eye - side, z) * optical_from_body();
}

}  // namespace glidar

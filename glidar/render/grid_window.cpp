// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/grid_window.hpp>

#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace glidar {

void find_plane_points(const Beams& beams, PlanePoints& points) {
  points.x.clear();
  points.y.clear();
  if (!beams.pinhole) return;
  for (std::uint32_t u = 0; u < beams.cols; ++u) points.x.push_back(plane_x(*beams.pinhole, u));
  for (std::uint32_t v = 0; v < beams.rows; ++v) points.y.push_back(plane_y(*beams.pinhole, v));
}

GLIDAR_SIMD void directions_through(const Lanes<double>& x, const Lanes<double>& y,
                                    Lanes3<double>& out) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double length = std::sqrt(x[i] * x[i] + y[i] * y[i] + 1.0);
    out.x[i] = x[i] / length;
    out.y[i] = y[i] / length;
    out.z[i] = 1.0 / length;
  }
}

Eigen::AlignedBox3d local_box(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh.positions_m) box.extend(p.cast<double>());
  return box;
}

void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m) {
  if (box.isEmpty()) return;
  const Eigen::Vector3d boresight = view.scale * view.object_from_sensor.col(2);
  const double middle = boresight.dot(box.center() - view.sensor_in_object);
  const double half = boresight.cwiseAbs().dot(0.5 * box.sizes());
  nearest_m = std::min(nearest_m, middle - half);
  farthest_m = std::max(farthest_m, middle + half);
}

DepthRange tight_depth_range(double nearest_m, double farthest_m) {
  // Single precision rounds a depth by 6e-8 of it, and positions by 6e-8 of the farthest depth.
  constexpr double kRounding = 0x1p-22;
  // Of the farthest depth; smaller depths are rounding errors.
  constexpr double kNearestPart = 1e-7;
  const double margin = kRounding * (farthest_m - std::max(nearest_m, 0.0)) +
                        0x1p-50 * (std::abs(farthest_m) + std::abs(nearest_m));
  const double far_m = farthest_m + margin;
  return {std::max(nearest_m - margin, kNearestPart * far_m), far_m};
}

namespace {

constexpr double kMinDepth = 1e-3;  // of the distance: up to 89.9 degrees from the boresight

/// True when a box projects to the covered part, as far as a sphere around it shows.
bool is_covered(const Eigen::AlignedBox2d& covered, const InstanceView& view,
                const Eigen::AlignedBox3d& box) {
  if (covered.isEmpty()) return false;
  const Eigen::Vector3d middle =
      view.object_from_sensor.transpose() * (box.center() - view.sensor_in_object);
  const double radius = 0.5 * box.sizes().norm();
  const double near = middle.z() - radius;
  if (!(near > kMinDepth * (middle.norm() + radius))) return false;
  const double far = middle.z() + radius;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = middle[axis] - radius;
    const double high = middle[axis] + radius;
    if (!(low / (low < 0.0 ? near : far) >= covered.min()[axis])) return false;
    if (!(high / (high > 0.0 ? near : far) <= covered.max()[axis])) return false;
  }
  return true;
}

/// Extends the covered part of the plane at depth 1 by a box (relative to the mesh's origin); false
/// when not all of the box is clearly in front of the sensor.
bool extend(Eigen::AlignedBox2d& covered, const InstanceView& view,
            const Eigen::AlignedBox3d& box) {
  constexpr int kCorners = 8;
  for (int i = 0; i < kCorners; ++i) {
    const auto which = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    const Eigen::Vector3d in_sensor =
        view.object_from_sensor.transpose() * (box.corner(which) - view.sensor_in_object);
    if (!(in_sensor.z() > kMinDepth * in_sensor.norm())) return false;
    covered.extend(Eigen::Vector2d(in_sensor.x() / in_sensor.z(), in_sensor.y() / in_sensor.z()));
  }
  return true;
}

/// Indices of a sorted row whose values are in [low, high], and one more on each side.
std::pair<std::uint32_t, std::uint32_t> index_range(const std::vector<double>& row, double low,
                                                    double high) {
  const auto first = std::lower_bound(row.begin(), row.end(), low) - row.begin();
  const auto end = std::upper_bound(row.begin(), row.end(), high) - row.begin();
  const auto last = static_cast<std::ptrdiff_t>(row.size());
  return {static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(first - 1, 0)),
          static_cast<std::uint32_t>(std::min(end + 1, last))};
}

}  // namespace

GridWindow visible_window(const Resolver& resolver, std::span<const Eigen::AlignedBox3d> mesh_boxes,
                          std::span<const std::uint8_t> instance_enabled,
                          const PlanePoints& points) {
  if (points.x.empty()) return {};
  const std::vector<Instance>& instances = resolver.scene().instances;
  Eigen::AlignedBox2d covered;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const Eigen::AlignedBox3d& box = mesh_boxes[instances[i].mesh];
    if (box.isEmpty() || (!instance_enabled.empty() && instance_enabled[i] == 0)) continue;
    const Eigen::Vector3d& origin_m = resolver.mesh(i).origin_m;
    const Eigen::AlignedBox3d relative(box.min() - origin_m, box.max() - origin_m);
    const InstanceView& view = resolver.view(i);
    if (!is_covered(covered, view, relative) && !extend(covered, view, relative)) return {};
  }
  if (covered.isEmpty()) return {.end_row = 0, .end_col = 0};
  const auto [first_row, end_row] = index_range(points.y, covered.min().y(), covered.max().y());
  const auto [first_col, end_col] = index_range(points.x, covered.min().x(), covered.max().x());
  return {first_row, end_row, first_col, end_col};
}

}  // namespace glidar

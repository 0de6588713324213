// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/grid_window.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace glidar {
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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/depth_range.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {

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

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/cloud_points.hpp>

#include <string>
#include <variant>

namespace glidar::app {

void make_cloud_points(const Snapshot& snapshot, const Eigen::Vector3d& anchor_m,
                       std::vector<Eigen::Vector3f>& points) {
  const Pose anchor_from_world(Eigen::Translation3d(-anchor_m));
  const OutputFrame target_frame{
      .frame_id = "anchor",
      .cloud_from_sensor = anchor_from_world * snapshot.frame.world_from_sensor};
  const std::vector<std::string> columns = {"xyz"};
  PointCloud cloud;
  make_point_cloud(snapshot.frame, *snapshot.beams, snapshot.prepared->scene, target_frame, columns,
                   cloud);
  const auto& xyz = std::get<std::vector<double>>(cloud.columns[0].values);
  points.resize(cloud.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Vector3d(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]).cast<float>();
  }
}

}  // namespace glidar::app

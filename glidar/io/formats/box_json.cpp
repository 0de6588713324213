// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/box_json.hpp>

namespace glidar {
namespace {

nlohmann::ordered_json three(const Eigen::Vector3d& v) {
  return nlohmann::ordered_json::array({v.x(), v.y(), v.z()});
}

}  // namespace

nlohmann::ordered_json box_json(const Scene& scene, const ObjectBox& box,
                                const Pose& cloud_from_sensor) {
  const Instance& instance = scene.instances.at(box.instance);
  const PoseVector pose = to_xyz_wxyz(cloud_from_sensor * box.sensor_from_box);
  const Eigen::Vector3d velocity_m_s = cloud_from_sensor.linear() * box.velocity_m_s;
  return {{"name", instance.name},
          {"id", instance.id},
          {"class_id", instance.class_id},
          {"class", scene.class_names.at(instance.class_id)},
          {"centre_m", three(pose.head<3>())},
          {"size_m", three(box.size_m)},
          {"orientation", {{"w", pose[3]}, {"x", pose[4]}, {"y", pose[5]}, {"z", pose[6]}}},
          {"velocity_m_s", three(velocity_m_s)},
          {"points", box.points},
          {"beams", box.beams},
          {"visible_beams", box.visible_beams},
          {"occlusion", occlusion(box)}};
}

}  // namespace glidar

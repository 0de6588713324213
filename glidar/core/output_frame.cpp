// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/output_frame.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <vector>

namespace glidar {

std::span<const std::string> output_frame_names() {
  static const std::vector<std::string> names = {"sensor", "optical", "ros",
                                                 "gl",     "world",   "legacy"};
  return names;
}

OutputFrame output_frame(const std::string& name, const Beams& beams,
                         const Pose& world_from_sensor) {
  const bool lidar = !looks_along_z(beams);
  const std::string prefix = lidar ? "lidar" : "camera";
  const Pose optical_from_sensor = lidar ? optical_from_body() : Pose::Identity();
  if (name == "sensor") return {.frame_id = beams.frame_id};
  if (name == "world") return {.frame_id = "world", .cloud_from_sensor = world_from_sensor};
  if (name == "ros") {
    const Pose body_from_sensor = optical_from_body().inverse() * optical_from_sensor;
    return {.frame_id = prefix + "_frame", .cloud_from_sensor = body_from_sensor};
  }
  if (name == "gl") {
    Pose gl_from_optical = Pose::Identity();
    gl_from_optical.linear().diagonal() = Eigen::Vector3d(1.0, -1.0, -1.0);
    return {.frame_id = prefix + "_gl_frame",
            .cloud_from_sensor = gl_from_optical * optical_from_sensor};
  }
  if (name == "legacy") {
    return {.frame_id = prefix + "_legacy_frame",
            .cloud_from_sensor = woods2016_from_optical() * optical_from_sensor};
  }
  if (name == "optical") {
    return {.frame_id = prefix + "_optical_frame", .cloud_from_sensor = optical_from_sensor};
  }
  const std::string nearest = closest_match(name, output_frame_names());
  throw Error({.where = "coordinate frame",
               .found = "'" + excerpt(name) + "'",
               .allowed = "sensor, optical, ros, gl, world, legacy",
               .remedy = nearest.empty() ? "" : "did you mean " + nearest + "?"});
}

}  // namespace glidar

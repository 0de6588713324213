// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/box_message.hpp>

#include <glidar/core/excerpt.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/formats/box_json.hpp>
#include <glidar/io/pictures/picture.hpp>

namespace glidar::ros {
namespace {

/// The colour of a class, transparent so that points inside are visible.
ColorRGBA colour_of(std::uint32_t class_id) {
  constexpr float kFull = 255.0F;
  constexpr float kOpacity = 0.3F;
  const Colour colour = category_colour(class_id);
  return {static_cast<float>(colour.r) / kFull, static_cast<float>(colour.g) / kFull,
          static_cast<float>(colour.b) / kFull, kOpacity};
}

std::string text_of(const Scene& scene, const ObjectBox& box) {
  nlohmann::ordered_json json = box_json(scene, box, Pose::Identity());
  remove_negative_zeros(json);
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Marker cube_of(const Scene& scene, const ObjectBox& box) {
  const Instance& instance = scene.instances.at(box.instance);
  const PoseVector pose = to_xyz_wxyz(box.sensor_from_box);
  Marker cube;
  cube.ns = printable_line(scene.class_names.at(instance.class_id));
  cube.id = static_cast<std::int32_t>(instance.id);  // ids from 2^31 become negative
  cube.type = Marker::kCube;
  cube.pose = {{pose[0], pose[1], pose[2]}, {pose[4], pose[5], pose[6], pose[3]}};
  cube.scale = {box.size_m.x(), box.size_m.y(), box.size_m.z()};
  cube.color = colour_of(instance.class_id);
  cube.text = text_of(scene, box);
  return cube;
}

}  // namespace

MarkerArray box_markers(const Scene& scene, const Frame& frame, const std::string& frame_id) {
  const Header header{.stamp = time_from_ns(frame.stamp_ns), .frame_id = frame_id};
  MarkerArray markers;
  for (const ObjectBox& box : frame.boxes) {
    markers.markers.push_back(cube_of(scene, box));
    markers.markers.back().header = header;
  }
  return markers;
}

}  // namespace glidar::ros

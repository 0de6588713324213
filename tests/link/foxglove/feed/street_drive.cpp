// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "street_drive.hpp"

#include <support/source_folder.hpp>

#include <glidar/core/point_cloud.hpp>
#include <glidar/explain/trace_text.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include "ros_bytes.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace glidar::testing {
namespace {

constexpr std::uint32_t kStep = 34;
constexpr std::array<CloudField, 9> kFields = {{{"x", 0, 7},
                                                {"y", 4, 7},
                                                {"z", 8, 7},
                                                {"intensity", 12, 7},
                                                {"ring", 16, 4},
                                                {"time", 18, 7},
                                                {"range", 22, 7},
                                                {"true_range", 26, 7},
                                                {"class", 30, 6}}};
constexpr std::uint32_t kImageWidth = 160;
constexpr std::uint32_t kImageHeight = 120;

Pose car_from_lidar() {
  return make_pose({0, 0, 1.9}, Eigen::Quaterniond::Identity());
}

Pose car_from_camera() {
  return look_at({1.2, 0, 1.5}, {10, 0, 1.2});
}

Scene street() {
  return load_scene_file(std::string(kSourceFolder) + "/examples/street.yaml", {}, {}).scene;
}

template <class Number>
void append(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <class Number>
const std::vector<Number>& values(const PointCloud& cloud, const char* name) {
  return std::get<std::vector<Number>>(find_column(cloud, name)->values);
}

}  // namespace

StreetDrive::StreetDrive(const std::string& sensor, int frames)
    : scene_(street()), lidar_(scene_, load_sensor_file(find_sensor_file(sensor))) {
  Sensor camera;
  camera.optics = pinhole_from_fov(kImageWidth, kImageHeight, 1.2);
  Simulator camera_simulator(scene_, camera);
  for (int frame = 0; frame < frames; ++frame) {
    simulate_cloud(frame);
    simulate_depth(camera_simulator, frame);
  }
}

Pose StreetDrive::world_from_car(int frame) const {
  constexpr double kStep_m = 0.5;
  const double x = -6.0 + kStep_m * frame;
  const double yaw = 0.05 * std::sin(0.3 * frame);
  return make_pose({x, -0.9, 0},
                   Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
}

Motion StreetDrive::motion(int frame, const Pose& car_from_sensor) const {
  return static_motion(scene_, world_from_car(frame) * car_from_sensor);
}

void StreetDrive::simulate_cloud(int frame) {
  Frame measured;
  measured.number = static_cast<std::uint32_t>(frame);
  measured.seed = 1;
  const std::vector<std::string> columns = {"xyz",   "intensity", "range", "true_range",
                                            "class", "ring",      "time"};
  lidar_.simulate(motion(frame, car_from_lidar()), hit_columns_for(columns), measured);
  PointCloud cloud;
  make_point_cloud(measured, *lidar_.beams(measured.number), scene_, {measured.frame_id}, columns,
                   cloud);
  std::string& bytes = points_.emplace_back();
  std::vector<std::size_t>& entries = entries_.emplace_back();
  const auto& xyz = values<double>(cloud, "xyz");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isfinite(xyz[3 * i])) continue;
    entries.push_back(i);
    for (std::size_t k = 0; k < 3; ++k) append(bytes, static_cast<float>(xyz[3 * i + k]));
    append(bytes, values<float>(cloud, "intensity")[i]);
    append(bytes, values<std::uint16_t>(cloud, "ring")[i]);
    append(bytes, 1e-9F * static_cast<float>(values<std::uint32_t>(cloud, "time")[i]));
    append(bytes, static_cast<float>(values<double>(cloud, "range")[i]));
    append(bytes, static_cast<float>(values<double>(cloud, "true_range")[i]));
    append(bytes, values<std::uint32_t>(cloud, "class")[i]);
  }
}

void StreetDrive::simulate_depth(Simulator& camera, int frame) {
  Frame measured;
  measured.seed = 1;
  const std::vector<std::string> columns = {"depth"};
  camera.simulate(motion(frame, car_from_camera()), hit_columns_for(columns), measured);
  PointCloud cloud;
  make_point_cloud(measured, *camera.beams(), scene_, {measured.frame_id}, columns, cloud);
  std::string& bytes = depths_.emplace_back();
  for (const double depth_m : values<double>(cloud, "depth")) {
    append(bytes, static_cast<std::uint16_t>(depth_m < 65.0 ? std::lround(depth_m * 1e3) : 0));
  }
}

link::Payload StreetDrive::cloud(int frame, std::uint64_t stamp_ns) const {
  return cloud_message(stamp_ns, "lidar", kFields, kStep, points_[static_cast<std::size_t>(frame)]);
}

link::Payload StreetDrive::depth_image(int frame, std::uint64_t stamp_ns) const {
  CdrWriter writer;
  writer.header(stamp_ns, "camera").put(kImageHeight).put(kImageWidth).text("16UC1");
  writer.put(std::uint8_t{0}).put(2 * kImageWidth);
  writer.sequence(depths_[static_cast<std::size_t>(frame)]);
  return writer.payload();
}

link::Payload StreetDrive::transform(int frame, std::uint64_t stamp_ns) const {
  return tf_message(stamp_ns, "map", "base_link", world_from_car(frame));
}

link::Payload StreetDrive::odometry(int frame, std::uint64_t stamp_ns) const {
  constexpr int kCovariance = 36;
  constexpr int kTwist = 6;
  CdrWriter writer;
  writer.header(stamp_ns, "map").text("base_link").pose(world_from_car(frame));
  for (int i = 0; i < 2 * kCovariance + kTwist; ++i) writer.put(0.0);
  return writer.payload();
}

link::Payload StreetDrive::static_transforms() {
  CdrWriter writer;
  writer.put(std::uint32_t{2});
  writer.header(0, "base_link").text("lidar").pose(car_from_lidar());
  writer.header(0, "base_link").text("camera").pose(car_from_camera());
  return writer.payload();
}

std::string StreetDrive::explain(int frame, std::size_t point) {
  const auto& entries = entries_[static_cast<std::size_t>(frame)];
  if (point >= entries.size()) return "there is no such point";
  Frame measured;
  measured.number = static_cast<std::uint32_t>(frame);
  measured.seed = 1;
  const PointTrace trace =
      glidar::explain(lidar_, motion(frame, car_from_lidar()), entries[point], measured);
  return format_trace(trace, lidar_, measured);
}

}  // namespace glidar::testing

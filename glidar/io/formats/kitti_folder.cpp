// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_folder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/kitti_file.hpp>
#include <glidar/io/pictures/image_box.hpp>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>

namespace glidar {
namespace {

/// The left colour camera of KITTI's first day (2011_09_26, P_rect_02), for LiDARs without one.
constexpr RectifiedCamera kKittiCamera = {721.5377, 721.5377, 609.5593, 172.854, 1242.0, 375.0};

RectifiedCamera camera_of(const Sensor& sensor) {
  const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
  if (pinhole == nullptr) return kKittiCamera;
  const PinholeIntrinsics& i = pinhole->intrinsics;
  return {i.fx,
          i.fy,
          i.cx - i.pixel_centre,
          i.cy - i.pixel_centre,
          static_cast<double>(i.width),
          static_cast<double>(i.height)};
}

/// KITTI's camera frame (x right, y down, z forward) at the sensor.
Pose camera_from_sensor(const Sensor& sensor) {
  const bool is_camera = std::holds_alternative<Pinhole>(sensor.optics);
  return is_camera ? Pose::Identity() : optical_from_body();
}

/// The points in the sensor's frame, which is used as KITTI's Velodyne frame.
PointCloud in_sensor_frame(const CloudFile& job) {
  PointCloud cloud = job.cloud;
  const Pose& world_from_sensor = job.frame.world_from_sensor;
  if (cloud.world_from_cloud.matrix() == world_from_sensor.matrix()) return cloud;
  const Pose sensor_from_cloud = world_from_sensor.inverse() * cloud.world_from_cloud;
  auto& xyz = std::get<std::vector<double>>(cloud.columns.front().values);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    Eigen::Map<Eigen::Vector3d> point(&xyz[i]);
    point = (sensor_from_cloud * point).eval();
  }
  return cloud;
}

/// A box with two horizontal faces in the camera's frame, as in KITTI.
struct LevelBox {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< length, height, width
  Eigen::Vector3d bottom = Eigen::Vector3d::Zero();  ///< centre of the lower face
  double rotation_y = 0.0;                           ///< from the camera's x to the object's x axis
};

/// The heading of an object's x axis; if that is vertical, of its y axis minus a quarter turn.
double heading(const Eigen::Matrix3d& camera_from_object) {
  constexpr double kUpright = 1e-6;
  const Eigen::Vector3d x = camera_from_object.col(0);
  if (std::hypot(x.x(), x.z()) > kUpright) return std::atan2(-x.z(), x.x());
  const Eigen::Vector3d y = camera_from_object.col(1);
  return std::atan2(-y.z(), y.x()) - std::numbers::pi / 2.0;
}

/// The angle normalised to -pi to pi.
double wrapped_angle(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

/// The tight box around the mesh in its heading.
LevelBox level_box(const PlacedMesh& seen) {
  LevelBox box;
  box.rotation_y = wrapped_angle(heading(seen.camera_from_object.linear()));
  const Eigen::Matrix3d camera_from_box =
      Eigen::AngleAxisd(box.rotation_y, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Eigen::AlignedBox3d extent;
  for (const Triangle& triangle : seen.mesh.triangles) {
    for (const std::uint32_t corner : triangle)
      extent.extend(camera_from_box.transpose() * seen.in_camera(corner));
  }
  box.size = extent.sizes();
  Eigen::Vector3d bottom = extent.center();
  bottom.y() = extent.max().y();
  box.bottom = camera_from_box * bottom;
  return box;
}

/// Six decimals, never -0.
std::string decimal(double value) {
  std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? "0.000000" : text;
}

std::string box_text(const std::optional<ImageBox>& box) {
  if (!box) return "-1 -1 -1 -1";
  const Eigen::AlignedBox2d& in = box->inside;
  return decimal(in.min().x()) + " " + decimal(in.min().y()) + " " + decimal(in.max().x()) + " " +
         decimal(in.max().y());
}

/// A class's name as one word.
std::string type_of(const std::string& name) {
  std::string word = name;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return std::isspace(c) != 0; }, '_');
  return word;
}

/// Occlusion state "unknown".
constexpr int kOcclusionUnknown = 3;

std::string object_line(const std::string& type, const PlacedMesh& seen,
                        const RectifiedCamera& camera) {
  const std::optional<ImageBox> image = image_box(seen, camera);
  const LevelBox box = level_box(seen);
  const double alpha = wrapped_angle(box.rotation_y - std::atan2(box.bottom.x(), box.bottom.z()));
  std::string line =
      fmt::format("{} {} {} {} {}", type, image ? decimal(image->truncated) : decimal(1.0),
                  kOcclusionUnknown, decimal(alpha), box_text(image));
  for (const double number : {box.size.y(), box.size.z(), box.size.x(), box.bottom.x(),
                              box.bottom.y(), box.bottom.z(), box.rotation_y}) {
    line += " " + decimal(number);
  }
  return line + "\n";
}

/// A region of the image without labels; empty when the object is not in the image.
std::string dont_care_line(const PlacedMesh& seen, const RectifiedCamera& camera) {
  const std::optional<ImageBox> image = image_box(seen, camera);
  if (!image) return "";
  return "DontCare -1 -1 -10 " + box_text(image) + " -1 -1 -1 -1000 -1000 -1000 -10\n";
}

/// A line of a calibration file: the first `rows` rows of a matrix, row by row.
std::string matrix_line(const char* name, const Eigen::Matrix4d& matrix, Eigen::Index cols) {
  std::string line = std::string(name) + ":";
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index col = 0; col < cols; ++col)
      line += fmt::format(" {:.12e}", matrix(row, col) + 0.0);  // -0 + 0 is 0
  }
  return line + "\n";
}

void add_text(const std::filesystem::path& path, const std::string& text, StagedFiles& files) {
  AtomicFile& file = files.add(path);
  file.write(text);
  file.finish();
}

}  // namespace

std::string kitti_calibration(const Sensor& sensor) {
  const RectifiedCamera camera = camera_of(sensor);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Identity();
  projection.block<2, 3>(0, 0) << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy;
  const Eigen::Matrix4d none = Eigen::Matrix4d::Identity();
  std::string text;
  for (const char* name : {"P0", "P1", "P2", "P3"}) text += matrix_line(name, projection, 4);
  text += matrix_line("R0_rect", none, 3);
  text += matrix_line("Tr_velo_to_cam", camera_from_sensor(sensor).matrix(), 4);
  return text + matrix_line("Tr_imu_to_velo", none, 4);
}

std::string kitti_labels(const Scene& scene, const Sensor& sensor, const Frame& frame) {
  const std::set<std::uint32_t> met(frame.ground_truth.instance.begin(),
                                    frame.ground_truth.instance.end());
  const RectifiedCamera camera = camera_of(sensor);
  const Pose camera_from_world = camera_from_sensor(sensor) * frame.world_from_sensor.inverse();
  std::string text;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (!met.contains(i)) continue;
    const Instance& instance = scene.instances[i];
    const PlacedMesh seen{scene.meshes.at(instance.mesh),
                          camera_from_world * frame.world_from_instance.at(i), instance.scale};
    const std::string type = type_of(scene.class_names.at(instance.class_id));
    text += instance.class_id == 0 ? dont_care_line(seen, camera) : object_line(type, seen, camera);
  }
  return text;
}

void stage_kitti_folder(const CloudFile& job, const std::filesystem::path& folder,
                        StagedFiles& files) {
  const SidecarContext& context = job.context;
  const bool is_labelled = has_classes(context.scene);
  files.add_folder(folder);
  for (const char* part : {"velodyne", "calib", "label_2", "labels"}) {
    if (is_labelled || part != std::string_view("labels")) files.add_folder(folder / part);
  }
  const std::string number = fmt::format("{:06}", job.frame.number);
  const PointCloud cloud = in_sensor_frame(job);
  const std::vector<PointField> fields = kitti_fields(cloud);
  const CloudFile velodyne{cloud, job.frame, job.options, context, fields};
  AtomicFile& points = files.add(folder / "velodyne" / (number + ".bin"));
  write_kitti(velodyne, points);
  points.finish();
  stage_kitti_labels(velodyne, folder / "labels" / (number + ".label"), files);
  add_text(folder / "calib" / (number + ".txt"), kitti_calibration(context.sensor), files);
  add_text(folder / "label_2" / (number + ".txt"),
           kitti_labels(context.scene, context.sensor, job.frame), files);
}

Format kitti_folder_format() {
  return {.info = {.suffix = ".kitti",
                   .description = "folder: velodyne calib label_2 labels",
                   .columns = {"xyz", "intensity"},
                   .is_folder = true,
                   .optional_columns = {"range", "instance", "class"}},
          .content = Content::kitti,
          .fields = kitti_fields,
          .stage_extra_files = stage_kitti_folder};
}

}  // namespace glidar

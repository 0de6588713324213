// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_labels.hpp>

#include <glidar/core/file_text.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <variant>

namespace glidar {
namespace {

/// The left colour camera of KITTI's first day (2011_09_26, P_rect_02), for LiDARs without one.
constexpr RectifiedCamera kKittiCamera = {721.5377, 721.5377, 609.5593, 172.854, 1242.0, 375.0};

RectifiedCamera intrinsics_of(const Pinhole& pinhole) {
  const PinholeIntrinsics& i = pinhole.intrinsics;
  return {i.fx,
          i.fy,
          i.cx - i.pixel_centre,
          i.cy - i.pixel_centre,
          static_cast<double>(i.width),
          static_cast<double>(i.height)};
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
  if (portable_hypot(x.x(), x.z()) > kUpright) return portable_atan2(-x.z(), x.x());
  const Eigen::Vector3d y = camera_from_object.col(1);
  return portable_atan2(-y.z(), y.x()) - std::numbers::pi / 2.0;
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
      axis_angle(Eigen::Vector3d::UnitY(), box.rotation_y).toRotationMatrix();
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

/// Occlusion states: 0 fully visible, 1 partly occluded, 2 largely occluded, 3 unknown. KITTI gives
/// no numbers.
int occlusion_state(const ObjectBox& box) {
  constexpr double kPartly = 0.1;
  constexpr double kLargely = 0.5;
  if (box.beams == 0) return 3;
  const double hidden = occlusion(box);
  if (hidden <= kPartly) return 0;
  return hidden <= kLargely ? 1 : 2;
}

const ObjectBox* box_of(const Frame& frame, std::uint32_t instance) {
  const auto found = std::find_if(frame.boxes.begin(), frame.boxes.end(),
                                  [&](const ObjectBox& box) { return box.instance == instance; });
  return found == frame.boxes.end() ? nullptr : &*found;
}

std::string object_line(const std::string& type, int occluded, const PlacedMesh& seen,
                        const RectifiedCamera& camera) {
  const std::optional<ImageBox> image = image_box(seen, camera);
  const LevelBox box = level_box(seen);
  const double alpha =
      wrapped_angle(box.rotation_y - portable_atan2(box.bottom.x(), box.bottom.z()));
  std::string line =
      fmt::format("{} {} {} {} {}", type, image ? decimal(image->truncated) : decimal(1.0),
                  occluded, decimal(alpha), box_text(image));
  for (const double number : {box.size.y(), box.size.z(), box.size.x(), box.bottom.x(),
                              box.bottom.y(), box.bottom.z(), box.rotation_y}) {
    line += ' ';
    line += decimal(number);
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

/// From the first camera's frame into the image of a camera, as pixels times depth.
Eigen::Matrix4d projection_of(const KittiCamera& camera, const Pose& first_from_velodyne) {
  Eigen::Matrix4d projection = Eigen::Matrix4d::Identity();
  const RectifiedCamera& in = camera.intrinsics;
  projection.block<2, 3>(0, 0) << in.fx, 0.0, in.cx, 0.0, in.fy, in.cy;
  if (camera.camera_from_velodyne.matrix() == first_from_velodyne.matrix()) return projection;
  return projection * (camera.camera_from_velodyne * first_from_velodyne.inverse()).matrix();
}

}  // namespace

KittiCamera kitti_camera(const Sensor& sensor) {
  const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
  if (pinhole != nullptr) return {intrinsics_of(*pinhole), Pose::Identity()};
  return {kKittiCamera, optical_from_body()};
}

std::optional<KittiCamera> kitti_camera(const Sensor& camera, const Pose& camera_from_velodyne) {
  const auto* pinhole = std::get_if<Pinhole>(&camera.optics);
  if (pinhole == nullptr || !is_perspective(*pinhole)) return {};
  return KittiCamera{intrinsics_of(*pinhole), camera_from_velodyne};
}

std::string kitti_calibration(std::span<const KittiCamera> cameras, KittiCalibration kind) {
  const Pose& first_from_velodyne = cameras[0].camera_from_velodyne;
  const Eigen::Matrix4d first = projection_of(cameras[0], first_from_velodyne);
  const Eigen::Matrix4d second =
      cameras.size() > 1 ? projection_of(cameras[1], first_from_velodyne) : first;
  std::string text;
  for (const char* name : {"P0", "P1", "P2"}) text += matrix_line(name, first, 4);
  text += matrix_line("P3", second, 4);
  if (kind == KittiCalibration::sequence) {
    return text + matrix_line("Tr", first_from_velodyne.matrix(), 4);
  }
  const Eigen::Matrix4d none = Eigen::Matrix4d::Identity();
  text += matrix_line("R0_rect", none, 3);
  text += matrix_line("Tr_velo_to_cam", first_from_velodyne.matrix(), 4);
  return text + matrix_line("Tr_imu_to_velo", none, 4);
}

std::string kitti_pose_line(const Pose& pose) {
  const std::string line = matrix_line("", pose.matrix(), 4);
  return line.substr(2);  // behind ": "
}

std::string kitti_labels(const Scene& scene, const KittiCamera& camera, const Frame& frame) {
  const std::set<std::uint32_t> met(frame.ground_truth.instance.begin(),
                                    frame.ground_truth.instance.end());
  const Pose camera_from_world = camera.camera_from_velodyne * frame.world_from_sensor.inverse();
  std::string text;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const ObjectBox* box = box_of(frame, i);
    if (!met.contains(i) || (instance.class_id != 0 && box == nullptr)) continue;
    const PlacedMesh seen{scene.meshes.at(instance.mesh),
                          camera_from_world * frame.world_from_instance.at(i), instance.scale};
    const std::string type = FileText(scene.class_names.at(instance.class_id)).word();
    text += instance.class_id == 0
                ? dont_care_line(seen, camera.intrinsics)
                : object_line(type, occlusion_state(*box), seen, camera.intrinsics);
  }
  return text;
}

}  // namespace glidar

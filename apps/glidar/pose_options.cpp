// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/pose_options.hpp>

#include <apps/glidar/help_text.hpp>
#include <apps/glidar/numbers.hpp>
#include <glidar/core/error.hpp>
#include <glidar/sensor/framing.hpp>

#include <CLI/CLI.hpp>

#include <cmath>
#include <vector>

namespace glidar::app {
namespace {

constexpr double kLegacyDistance_m = 1000.0;  // --camera-z of the 2015 program

/// From the front right and above, for models whose up is +z and whose front is -y.
const Eigen::Vector3d& three_quarters() {
  static const Eigen::Vector3d kDirection(2.0, -3.0, 2.0);
  return kDirection;
}

[[noreturn]] void fail(std::string where, std::string found, std::string remedy) {
  throw Error({.where = std::move(where),
               .found = std::move(found),
               .allowed = "",
               .remedy = std::move(remedy)});
}

/// An attitude given as a quaternion or as an angle and axis; nothing when not given.
std::optional<Eigen::Quaterniond> attitude(const std::string& name, const std::string& quaternion,
                                           const std::string& angle_axis) {
  if (!quaternion.empty() && !angle_axis.empty()) {
    fail(name + "-q and " + name + "-r", "both are given", "give one of them");
  }
  if (!quaternion.empty()) return parse_quaternion(name + "-q", quaternion);
  if (!angle_axis.empty()) return parse_angle_axis(name + "-r", angle_axis);
  return std::nullopt;
}

bool legacy_given(const PoseFlags& flags) {
  return flags.camera_z || !flags.camera_q.empty() || !flags.camera_r.empty();
}

bool eye_given(const PoseFlags& flags) {
  return !flags.eye.empty() || !flags.target.empty();
}

/// The point that --eye without --target heads for. A LiDAR stays upright.
Eigen::Vector3d usual_target(const Eigen::Vector3d& eye, const Scene& scene,
                             const Eigen::Vector3d& up, bool upright) {
  const Eigen::AlignedBox3d box = bounds(scene);
  const Eigen::Vector3d middle =
      box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
  if (!upright) return middle;
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d way = middle - eye;
  const Eigen::Vector3d level = way - way.dot(z) * z;
  constexpr double kStraightBelow = 1e-9;
  return eye + (level.norm() > kStraightBelow * way.norm() ? level : z.unitOrthogonal());
}

Pose eye_pose(const PoseFlags& flags, const Scene& scene, const Eigen::Vector3d& up, bool upright) {
  if (flags.eye.empty()) fail("--target", "there is no --eye", "give --eye x,y,z too");
  const Eigen::Vector3d eye = parse_vector("--eye", flags.eye);
  const Eigen::Vector3d target = flags.target.empty() ? usual_target(eye, scene, up, upright)
                                                      : parse_vector("--target", flags.target);
  return look_at(eye, target, up);
}

Pose explicit_pose(const PoseFlags& flags) {
  const std::vector<double> n =
      parse_numbers("--sensor-pose", flags.sensor_pose, 7, "x,y,z,qw,qx,qy,qz");
  return make_pose({n[0], n[1], n[2]}, Eigen::Quaterniond(n[3], n[4], n[5], n[6]));
}

Pose legacy_pose(const PoseFlags& flags) {
  const double distance_m = flags.camera_z.value_or(kLegacyDistance_m);
  if (!std::isfinite(distance_m)) fail("--camera-z", "not a finite number", "give metres");
  const auto camera_q = attitude("--camera", flags.camera_q, flags.camera_r);
  return legacy_world_from_optical(camera_q.value_or(Eigen::Quaterniond::Identity()), distance_m);
}

CLI::Option* add_text(CLI::App& command, const std::string& name, std::string& text,
                      const std::string& form, const std::string& description) {
  return command.add_option(name, text, wrapped(description))->type_name(form);
}

void add_legacy_flags(CLI::App& command, PoseFlags& flags) {
  const std::string group = "Pose as in the 2015 program";
  add_text(command, "--model-q", flags.model_q, "W,X,Y,Z", "Model attitude, quaternion")
      ->group(group);
  add_text(command, "--model-r", flags.model_r, "ANGLE,X,Y,Z", "Model attitude, radians and axis")
      ->group(group);
  add_text(command, "--camera-q", flags.camera_q, "W,X,Y,Z", "Sensor attitude, quaternion")
      ->group(group);
  add_text(command, "--camera-r", flags.camera_r, "ANGLE,X,Y,Z",
           "Sensor attitude, radians and axis")
      ->group(group);
  command.add_option("--camera-z", flags.camera_z, "Distance D from sensor to object, m [1000]")
      ->type_name("D")
      ->group(group);
}

}  // namespace

void add_pose_flags(CLI::App& command, PoseFlags& flags) {
  const std::string group = "Pose (default: the scene fills the view, seen from 2,-3,2)";
  add_text(command, "--eye", flags.eye, "X,Y,Z", "Sensor position in the world, m")->group(group);
  add_text(command, "--target", flags.target, "X,Y,Z",
           "Point the sensor looks at, m [the scene's middle; LiDARs stay upright]")
      ->group(group);
  add_text(command, "--up-vector", flags.up_vector, "X,Y,Z",
           "World direction that is up in the image [0,0,1]")
      ->group(group);
  add_text(command, "--sensor-pose", flags.sensor_pose, "X,Y,Z,QW,QX,QY,QZ",
           "world_from_sensor: position in m, attitude of the sensor's own frame")
      ->group(group);
  command.add_option("--scale", flags.scale, "Scale of the model, after --unit [1]")
      ->type_name("S")
      ->group("Model");
  add_legacy_flags(command, flags);
}

Pose legacy_from_optical() {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() = Eigen::Vector3d(-1.0, -1.0, 1.0);
  return pose;
}

Pose legacy_world_from_object(const Eigen::Quaterniond& model_q) {
  return make_pose(Eigen::Vector3d::Zero(), model_q.conjugate());
}

Pose legacy_world_from_optical(const Eigen::Quaterniond& camera_q, double distance_m) {
  return make_pose({0.0, 0.0, -distance_m}, camera_q.conjugate()) * legacy_from_optical();
}

void pose_model(const PoseFlags& flags, Scene& scene) {
  const auto model_q = attitude("--model", flags.model_q, flags.model_r);
  if (!model_q && !flags.scale) return;
  if (scene.instances.size() != 1) {
    fail("--scale, --model-q, --model-r",
         "the scene has " + std::to_string(scene.instances.size()) + " objects",
         "these options move a single model; write poses and scales into the scene file");
  }
  if (flags.scale) {
    require_positive("--scale", *flags.scale);
    scene.instances[0].scale *= *flags.scale;
  }
  if (!model_q) return;
  if (!scene.instances[0].world_from_object.isApprox(Pose::Identity())) {
    fail("--model-q, --model-r", "the scene file already gives the model's pose",
         "turn it in the scene file");
  }
  scene.instances[0].world_from_object = legacy_world_from_object(*model_q);
}

bool sensor_pose_given(const PoseFlags& flags) {
  return eye_given(flags) || legacy_given(flags) || !flags.sensor_pose.empty();
}

bool heads_along_x(const Beams& beams) {
  return beams.boresight.isApprox(Eigen::Vector3d::UnitX());
}

Pose pose_sensor(const PoseFlags& flags, const ScenePose& from_scene_file, const Beams& beams,
                 const Scene& scene) {
  const int ways =
      int{eye_given(flags)} + int{legacy_given(flags)} + int{!flags.sensor_pose.empty()};
  if (ways > 1) {
    fail("sensor pose", "it is given in several ways",
         "give --eye and --target, or --sensor-pose, or --camera-z with --camera-q");
  }
  const bool up_used = eye_given(flags) || (ways == 0 && !from_scene_file.world_from_sensor);
  if (!up_used && !flags.up_vector.empty()) {
    fail("--up-vector", "the pose is already complete", "leave it out, or give --eye");
  }
  const Eigen::Vector3d up = flags.up_vector.empty() ? Eigen::Vector3d(Eigen::Vector3d::UnitZ())
                                                     : parse_vector("--up-vector", flags.up_vector);
  const bool along_x = heads_along_x(beams);
  const Pose optical_from_sensor = along_x ? optical_from_body() : Pose::Identity();
  if (eye_given(flags)) return eye_pose(flags, scene, up, along_x) * optical_from_sensor;
  if (legacy_given(flags)) return legacy_pose(flags) * optical_from_sensor;
  if (!flags.sensor_pose.empty()) return explicit_pose(flags);
  if (from_scene_file.world_from_sensor) {
    return from_scene_file.looks_at ? *from_scene_file.world_from_sensor * optical_from_sensor
                                    : *from_scene_file.world_from_sensor;
  }
  return along_x ? stand_beside(beams, scene, three_quarters(), up)
                 : frame_view(beams, scene, three_quarters(), up);
}

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/pose_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <glidar/core/error.hpp>
#include <glidar/sensor/view_placement.hpp>

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

/// An attitude given as a quaternion or as an angle and axis; nothing when not given.
std::optional<Eigen::Quaterniond> attitude(const std::string& name, const std::string& quaternion,
                                           const std::string& angle_axis) {
  if (!quaternion.empty() && !angle_axis.empty()) {
    throw Error({.where = name + "-q and " + name + "-r",
                 .found = "both are given",
                 .allowed = "",
                 .remedy = "give one of them"});
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

std::string text_of(const Eigen::Vector3d& v) {
  return number_text(v.x()) + "," + number_text(v.y()) + "," + number_text(v.z());
}

/// Throws Error naming the options unless an image that looks this way has a definite upright.
void check_upright(const char* options, const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  constexpr double kMinSine = 1e-9;  // as look_at has it
  const Eigen::Vector3d z = forward.stableNormalized();
  if (z.cross(up.stableNormalized()).norm() > kMinSine) return;
  Eigen::Index flattest = 0;
  z.cwiseAbs().minCoeff(&flattest);
  throw Error({.where = options,
               .found = "the sensor looks along " + text_of(z) + ", parallel to its up vector " +
                        text_of(up),
               .allowed = "an up vector that is neither 0 nor parallel to the line of sight",
               .remedy = "for example --up-vector " +
                         text_of(Eigen::Vector3d(Eigen::Vector3d::Unit(flattest)))});
}

Eigen::Vector3d middle_of(const Scene& scene) {
  const Eigen::AlignedBox3d box = bounds(scene);
  return box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
}

/// A LiDAR that nothing aims: x forward and z up as in the world, whatever the scene. Another up
/// direction tilts it, with the heading as near to the world's x as that allows.
Pose level_pose(const Eigen::Vector3d& eye, const std::optional<Eigen::Vector3d>& up) {
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  if (!up) return Pose(Eigen::Translation3d(eye));
  check_upright("--eye and --up-vector", forward, *up);
  const Eigen::Vector3d z = up->stableNormalized();
  Pose pose = Pose::Identity();
  pose.linear().col(2) = z;
  pose.linear().col(0) = (forward - forward.dot(z) * z).normalized();
  pose.linear().col(1) = z.cross(pose.linear().col(0));
  pose.translation() = eye;
  return pose;
}

/// The pose by --eye, --target and --up-vector.
Pose eye_pose(const PoseFlags& flags, const Scene& scene, const std::optional<Eigen::Vector3d>& up,
              bool along_x) {
  if (flags.eye.empty())
    throw Error({.where = "--target",
                 .found = "there is no --eye",
                 .allowed = "",
                 .remedy = "give --eye x,y,z too"});
  const Eigen::Vector3d eye = parse_position("--eye", flags.eye);
  if (along_x && flags.target.empty()) return level_pose(eye, up);
  const Eigen::Vector3d target =
      flags.target.empty() ? middle_of(scene) : parse_position("--target", flags.target);
  if (eye == target) {
    throw Error({.where = "--eye",
                 .found = "'" + flags.eye + "' is the point looked at",
                 .allowed = "",
                 .remedy = "give another --eye or --target"});
  }
  if (up) check_upright("--eye, --target and --up-vector", target - eye, *up);
  const Pose world_from_optical = up ? look_at(eye, target, *up) : look_at(eye, target);
  return along_x ? world_from_optical * optical_from_body() : world_from_optical;
}

Pose parse_pose(std::string_view option, const std::string& text) {
  const std::vector<double> n = parse_numbers(option, text, 7, "x,y,z,qw,qx,qy,qz");
  const Eigen::Vector3d position(n[0], n[1], n[2]);
  check_reach(option, position);
  return make_pose(position, unit_quaternion(option, {n[3], n[4], n[5], n[6]}));
}

Pose legacy_pose(const PoseFlags& flags) {
  const double distance_m = flags.camera_z.value_or(kLegacyDistance_m);
  require(std::abs(distance_m) <= kMaxCoordinate_m, "--camera-z", distance_m,
          "metres from -1e15 to 1e15");
  const auto camera_q = attitude("--camera", flags.camera_q, flags.camera_r);
  return legacy_world_from_optical(camera_q.value_or(Eigen::Quaterniond::Identity()), distance_m);
}

void add_legacy_flags(CLI::App& command, PoseFlags& flags) {
  const std::string group = "Pose as in the 2015 program";
  const std::string axis_form = "ANGLE,X,Y,Z";
  add_text(command, {"--model-q", "W,X,Y,Z", "Model attitude, quaternion", group}, flags.model_q,
           parse_quaternion);
  add_text(command, {"--model-r", axis_form, "Model attitude, radians and axis", group},
           flags.model_r, parse_angle_axis);
  add_text(command, {"--camera-q", "W,X,Y,Z", "Sensor attitude, quaternion", group}, flags.camera_q,
           parse_quaternion);
  add_text(command, {"--camera-r", axis_form, "Sensor attitude, radians and axis", group},
           flags.camera_r, parse_angle_axis);
  add_number(command, {"--camera-z", "D", "Distance from sensor to object, m [1000]", group},
             flags.camera_z);
}

}  // namespace

void add_pose_flags(CLI::App& command, PoseFlags& flags) {
  const std::string group = "Pose (default: the scene fills the view, seen from 2,-3,2)";
  add_text(command, {"--eye", "X,Y,Z", "Sensor position in the world, m", group}, flags.eye,
           parse_position);
  add_text(
      command,
      {"--target", "X,Y,Z", "Point the sensor looks at, m [the scene; LiDARs: along x]", group},
      flags.target, parse_position);
  add_text(command,
           {"--up-vector", "X,Y,Z",
            "Direction up in the image [0,0,1; 1,0,0 if it looks vertically]", group},
           flags.up_vector, parse_vector);
  add_text(command,
           {"--sensor-pose", "X,Y,Z,QW,QX,QY,QZ",
            "Position in the world, m, and attitude of the sensor's frame", group},
           flags.sensor_pose, parse_pose);
  add_number(command, {"--scale", "S", "Scale of the model, after --unit [1]", "Model"},
             flags.scale);
  add_legacy_flags(command, flags);
}

Pose legacy_world_from_object(const Eigen::Quaterniond& model_q) {
  return make_pose(Eigen::Vector3d::Zero(), model_q.conjugate());
}

Pose legacy_world_from_optical(const Eigen::Quaterniond& camera_q, double distance_m) {
  return legacy_world_from_optical(camera_q, Eigen::Vector3d(0.0, 0.0, distance_m));
}

Pose legacy_world_from_optical(const Eigen::Quaterniond& camera_q,
                               const Eigen::Vector3d& translation_m) {
  return make_pose(-translation_m, camera_q.conjugate()) * woods2016_from_optical();
}

void pose_model(const PoseFlags& flags, Scene& scene) {
  const auto model_q = attitude("--model", flags.model_q, flags.model_r);
  if (!model_q && !flags.scale) return;
  if (scene.instances.size() != 1) {
    throw Error(
        {.where = "--scale, --model-q, --model-r",
         .found = "the scene has " + std::to_string(scene.instances.size()) + " objects",
         .allowed = "",
         .remedy =
             "these options move a single model; write poses and scales into the scene file"});
  }
  if (flags.scale) {
    require(*flags.scale >= kMinScale && *flags.scale <= kMaxScale, "--scale", *flags.scale,
            "a number above 0, from 1e-15 to 1e15");
    scene.instances[0].scale *= *flags.scale;
  }
  if (!model_q) return;
  if (!scene.instances[0].world_from_object.isApprox(Pose::Identity())) {
    throw Error({.where = "--model-q, --model-r",
                 .found = "the scene file already gives the model's pose",
                 .allowed = "",
                 .remedy = "turn it in the scene file"});
  }
  scene.instances[0].world_from_object = legacy_world_from_object(*model_q);
}

bool sensor_pose_given(const PoseFlags& flags) {
  return eye_given(flags) || legacy_given(flags) || !flags.sensor_pose.empty();
}

Pose pose_sensor(const PoseFlags& flags, const ScenePose& from_scene_file, const Beams& beams,
                 const Scene& scene) {
  const int ways =
      int{eye_given(flags)} + int{legacy_given(flags)} + int{!flags.sensor_pose.empty()};
  if (ways > 1) {
    throw Error(
        {.where = "--eye, --sensor-pose and --camera-z",
         .found = "the pose is given in several ways",
         .allowed = "",
         .remedy = "give --eye and --target, or --sensor-pose, or --camera-z with --camera-q"});
  }
  const bool up_used = eye_given(flags) || (ways == 0 && !from_scene_file.world_from_sensor);
  if (!up_used && !flags.up_vector.empty()) {
    throw Error({.where = "--up-vector",
                 .found = "the pose is already complete",
                 .allowed = "",
                 .remedy = "leave it out, or give --eye"});
  }
  const std::optional<Eigen::Vector3d> up_given =
      flags.up_vector.empty() ? std::nullopt
                              : std::optional(parse_vector("--up-vector", flags.up_vector));
  const Eigen::Vector3d up = up_given.value_or(Eigen::Vector3d::UnitZ());
  const bool along_x = !looks_along_z(beams);
  const Pose optical_from_sensor = along_x ? optical_from_body() : Pose::Identity();
  if (eye_given(flags)) return eye_pose(flags, scene, up_given, along_x);
  if (legacy_given(flags)) return legacy_pose(flags) * optical_from_sensor;
  if (!flags.sensor_pose.empty()) return parse_pose("--sensor-pose", flags.sensor_pose);
  if (from_scene_file.world_from_sensor) {
    return from_scene_file.looks_at ? *from_scene_file.world_from_sensor * optical_from_sensor
                                    : *from_scene_file.world_from_sensor;
  }
  check_upright("--up-vector", -three_quarters(), up);
  return along_x ? place_lidar_beside(beams, scene, three_quarters(), up)
                 : fit_camera_to_scene(beams, scene, three_quarters(), up);
}

}  // namespace glidar::app

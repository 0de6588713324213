// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/placement.hpp>

#include <apps/glidar/options/option_values.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/sensor/view_placement.hpp>

#include <string>

namespace glidar::app {
namespace {

constexpr double kLegacyDistance_m = 1000.0;  // --camera-z of the original GLIDAR

/// From the front right and above, for models whose up is +z and whose front is -y.
const Eigen::Vector3d& default_view_direction() {
  static const Eigen::Vector3d kDirection(2.0, -3.0, 2.0);
  return kDirection;
}

bool woods2016_pose_given(const PoseFlags& flags) {
  return flags.camera_z_m || flags.camera_q;
}

std::string text_of(const Eigen::Vector3d& v) {
  return number_text(v.x()) + "," + number_text(v.y()) + "," + number_text(v.z());
}

/// Throws Error naming the options when the forward direction is parallel to the up vector.
void check_upright(const char* options, const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  constexpr double kMinSine = 1e-9;  // as in look_at()
  const Eigen::Vector3d z = forward.stableNormalized();
  if (z.cross(up.stableNormalized()).norm() > kMinSine) return;
  Eigen::Index most_perpendicular = 0;
  z.cwiseAbs().minCoeff(&most_perpendicular);
  throw Error({.where = options,
               .found = "the sensor looks along " + text_of(z) + ", parallel to its up vector " +
                        text_of(up),
               .allowed = "an up vector that is neither 0 nor parallel to the line of geometry",
               .remedy = "for example --up-vector " +
                         text_of(Eigen::Vector3d(Eigen::Vector3d::Unit(most_perpendicular)))});
}

Eigen::Vector3d centre_of(const Scene& scene) {
  const Eigen::AlignedBox3d box = bounds(scene);
  return box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
}

/// A LiDAR without a target: x forward and z up as in the world, whatever the scene. Another up
/// direction tilts it, with the heading as close to the world's x as possible.
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
Pose eye_pose(const PoseFlags& flags, const Scene& scene, bool is_lidar) {
  const Eigen::Vector3d& eye = *flags.eye_m;
  if (is_lidar && !flags.target_m) return level_pose(eye, flags.up);
  const Eigen::Vector3d target = flags.target_m ? *flags.target_m : centre_of(scene);
  if (eye == target) {
    throw Error({.where = "--eye",
                 .found = "'" + text_of(eye) + "' is the point that the sensor looks at",
                 .remedy = "give another --eye or --target"});
  }
  if (flags.up) check_upright("--eye, --target and --up-vector", target - eye, *flags.up);
  const Pose world_from_optical = flags.up ? look_at(eye, target, *flags.up) : look_at(eye, target);
  return is_lidar ? world_from_optical * optical_from_body() : world_from_optical;
}

Pose woods2016_pose(const PoseFlags& flags) {
  return woods2016_world_from_optical(flags.camera_q.value_or(Eigen::Quaterniond::Identity()),
                                      flags.camera_z_m.value_or(kLegacyDistance_m));
}

TimedPoses load_sensor_poses(const MotionFlags& flags) {
  const TrajectoryFileOptions options{.rate_hz = flags.trajectory_rate_hz,
                                      .times_file = flags.trajectory_times,
                                      .interpolation = flags.trajectory_interpolation};
  return load_trajectory_file(flags.trajectory, options);
}

}  // namespace

Pose woods2016_world_from_object(const Eigen::Quaterniond& model_q) {
  return make_pose(Eigen::Vector3d::Zero(), model_q.conjugate());
}

Pose woods2016_world_from_optical(const Eigen::Quaterniond& camera_q, double distance_m) {
  return woods2016_world_from_optical(camera_q, Eigen::Vector3d(0.0, 0.0, distance_m));
}

Pose woods2016_world_from_optical(const Eigen::Quaterniond& camera_q,
                                  const Eigen::Vector3d& translation_m) {
  return make_pose(-translation_m, camera_q.conjugate()) * woods2016_from_optical();
}

void pose_model(const PoseFlags& flags, Scene& scene) {
  if (!flags.model_q && !flags.scale) return;
  if (scene.instances.size() != 1) {
    throw Error(
        {.where = "--scale, --model-q, --model-r",
         .found = "the scene has " + std::to_string(scene.instances.size()) + " objects",
         .remedy =
             "these options move a single model; write poses and scales into the scene file"});
  }
  Instance& instance = scene.instances[0];
  if (flags.scale) {
    with_option_name("--scale", [&] {
      set_scale(scene, 0, scale_of(scene, instance).cwiseProduct(*flags.scale));
    });
  }
  if (!flags.model_q) return;
  if (!instance.world_from_object.isApprox(Pose::Identity())) {
    throw Error({.where = "--model-q, --model-r",
                 .found = "the scene file already gives the model's pose",
                 .remedy = "rotate it in the scene file"});
  }
  instance.world_from_object = woods2016_world_from_object(*flags.model_q);
}

bool sensor_pose_given(const PoseFlags& flags) {
  return flags.eye_m || flags.world_from_sensor || woods2016_pose_given(flags);
}

Pose pose_sensor(const PoseFlags& flags, const ScenePose& from_scene_file, const Beams& beams,
                 const Scene& scene) {
  const bool is_complete = flags.world_from_sensor || woods2016_pose_given(flags) ||
                           (!flags.eye_m && from_scene_file.world_from_sensor);
  if (is_complete && flags.up) {
    throw Error({.where = "--up-vector",
                 .found = "the pose is already complete",
                 .remedy = "leave it out, or give --eye"});
  }
  const bool is_lidar = !looks_along_z(beams);
  const Pose optical_from_sensor = is_lidar ? optical_from_body() : Pose::Identity();
  if (flags.eye_m) return eye_pose(flags, scene, is_lidar);
  if (flags.world_from_sensor) return *flags.world_from_sensor;
  if (woods2016_pose_given(flags)) return woods2016_pose(flags) * optical_from_sensor;
  if (from_scene_file.world_from_sensor) {
    return from_scene_file.looks_at ? *from_scene_file.world_from_sensor * optical_from_sensor
                                    : *from_scene_file.world_from_sensor;
  }
  const Eigen::Vector3d up = flags.up.value_or(Eigen::Vector3d::UnitZ());
  check_upright("--up-vector", -default_view_direction(), up);
  return is_lidar ? place_lidar_beside(beams, scene, default_view_direction(), up)
                  : fit_camera_to_scene(beams, scene, default_view_direction(), up);
}

Trajectory sensor_trajectory(const MotionFlags& flags, const Pose& world_from_sensor,
                             const Pose& optical_from_sensor, bool pose_given,
                             const std::optional<Trajectory>& from_scene_file) {
  if (!flags.trajectory.empty()) return load_sensor_poses(flags);
  if (!flags.sensor_rate_rad_s) {
    if (from_scene_file && !pose_given) return *from_scene_file;
    return ConstantPose{world_from_sensor};
  }
  if (from_scene_file && !pose_given) {
    throw Error({.where = "--sensor-rate",
                 .found = "the scene file already moves the sensor",
                 .remedy = "leave the option out"});
  }
  return Spin{.pose = world_from_sensor,
              .rate_rad_s = (woods2016_from_optical() * optical_from_sensor).linear().transpose() *
                            *flags.sensor_rate_rad_s};
}

std::vector<Trajectory> instance_trajectories(const MotionFlags& flags, const Scene& scene,
                                              const std::vector<Trajectory>& from_scene_file) {
  if (!flags.object_rate_rad_s) return from_scene_file;
  if (scene.instances.size() != 1 || !from_scene_file.empty()) {
    throw Error(
        {.where = "--object-rate",
         .found = from_scene_file.empty()
                      ? "the scene has " + std::to_string(scene.instances.size()) + " objects"
                      : "the scene file already moves its objects",
         .remedy = "write the motion into the scene file"});
  }
  return {
      Spin{.pose = scene.instances[0].world_from_object, .rate_rad_s = *flags.object_rate_rad_s}};
}

}  // namespace glidar::app

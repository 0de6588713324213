// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/motion_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <apps/glidar/options/pose_options.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/formats/trajectory_file.hpp>

#include <cmath>
#include <utility>

namespace glidar::app {
namespace {

Eigen::Vector3d parse_rate(std::string_view option, const std::string& text) {
  constexpr double kMax_rad_s = 1e9;
  const Eigen::Vector3d rate = parse_vector(option, text);
  if (rate.cwiseAbs().maxCoeff() <= kMax_rad_s) return rate;
  throw Error({std::string(option), "'" + text + "'", "rad/s from -1e9 to 1e9", ""});
}

TimedPoses load_sensor_poses(const MotionFlags& flags) {
  constexpr double kMax_s = 9.2e9;
  TrajectoryFileOptions options{.rate_hz = flags.trajectory_rate_hz,
                                .times_file = flags.trajectory_times};
  if (const auto& start_s = flags.trajectory_start_s) {
    if (!(std::abs(*start_s) <= kMax_s)) {
      throw Error({"--trajectory-start", number_text(*start_s), "seconds up to 9.2e9", ""});
    }
    options.start_ns = std::llround(*start_s * 1e9);
  }
  return load_trajectory_file(flags.trajectory, options);
}

void check(const MotionFlags& flags, bool pose_given) {
  if (flags.trajectory.empty()) {
    if (flags.trajectory_rate_hz || !flags.trajectory_times.empty() || flags.trajectory_start_s) {
      throw Error({.where = "--trajectory-rate, --trajectory-times, --trajectory-start",
                   .found = "there is no --trajectory",
                   .allowed = "",
                   .remedy = "give --trajectory FILE too"});
    }
    return;
  }
  if (pose_given || !flags.camera_dr.empty()) {
    throw Error({.where = "--trajectory",
                 .found = "given beside options that say where the sensor is or how it turns",
                 .allowed = "",
                 .remedy = "leave out one or the other"});
  }
}

}  // namespace

void add_motion_flags(CLI::App& command, MotionFlags& flags) {
  const std::string group = "Motion";
  add_text(command,
           {"--trajectory", "FILE",
            "Poses of the sensor over time: TUM, KITTI, CSV (docs/files.md)", group},
           flags.trajectory);
  add_number(command, {"--trajectory-rate", "HZ", "Poses per second of a KITTI file, Hz", group},
             flags.trajectory_rate_hz);
  add_text(command, {"--trajectory-times", "FILE", "Times of a KITTI file, one a line", group},
           flags.trajectory_times);
  add_number(command,
             {"--trajectory-start", "S", "Its first time becomes this, s [as in the file]", group},
             flags.trajectory_start_s);
  const auto check_rate = [](std::string_view option, const std::string& text) {
    (void)parse_rate(option, text);
  };
  add_text(command,
           {"--object-rate", "X,Y,Z", "As in 2015: the model turns, rad/s about its axes", group},
           flags.model_dr, check_rate);
  add_text(
      command,
      {"--sensor-rate", "X,Y,Z", "As in 2015: the sensor turns, rad/s (left, up, forward)", group},
      flags.camera_dr, check_rate);
}

Trajectory sensor_trajectory(const MotionFlags& flags, const Pose& world_from_sensor,
                             const Pose& optical_from_sensor, bool pose_given,
                             const std::optional<Trajectory>& from_scene_file) {
  check(flags, pose_given);
  if (!flags.trajectory.empty()) return load_sensor_poses(flags);
  if (flags.camera_dr.empty()) {
    if (from_scene_file && !pose_given) return *from_scene_file;
    return ConstantPose{world_from_sensor};
  }
  if (from_scene_file && !pose_given) {
    throw Error({.where = "--sensor-rate",
                 .found = "the scene file already moves the sensor",
                 .allowed = "",
                 .remedy = "leave the option out"});
  }
  const Eigen::Vector3d legacy_rate = parse_rate("--sensor-rate", flags.camera_dr);
  return Spin{.pose = world_from_sensor,
              .rate_rad_s = (woods2016_from_optical() * optical_from_sensor).linear().transpose() *
                            legacy_rate};
}

std::vector<Trajectory> instance_trajectories(const MotionFlags& flags, const Scene& scene,
                                              const std::vector<Trajectory>& from_scene_file) {
  if (flags.model_dr.empty()) return from_scene_file;
  if (scene.instances.size() != 1 || !from_scene_file.empty()) {
    throw Error(
        {.where = "--object-rate",
         .found = from_scene_file.empty()
                      ? "the scene has " + std::to_string(scene.instances.size()) + " objects"
                      : "the scene file already moves its objects",
         .allowed = "",
         .remedy = "write the motion into the scene file"});
  }
  return {Spin{.pose = scene.instances[0].world_from_object,
               .rate_rad_s = parse_rate("--object-rate", flags.model_dr)}};
}

std::vector<std::string> files_of(const MotionFlags& flags) {
  std::vector<std::string> files;
  for (const std::string& file : {flags.trajectory, flags.trajectory_times}) {
    if (!file.empty()) files.push_back(file);
  }
  return files;
}

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

#include <optional>
#include <string>

namespace glidar::app {

/// Where sensor and model stand, as given; empty: not given.
struct PoseFlags {
  std::string eye = {};
  std::string target = {};
  std::string up_vector = {};
  std::string sensor_pose = {};
  std::string model_q = {};
  std::string model_r = {};
  std::string camera_q = {};
  std::string camera_r = {};
  std::optional<double> camera_z = {};
  std::optional<double> scale = {};
};

/// The sensor's pose in a scene file.
struct ScenePose {
  std::optional<Pose> world_from_sensor = {};
  bool looks_at = false;  ///< it was given by look_at, for a boresight +z
};

void add_pose_flags(CLI::App& command, PoseFlags& flags);

/// The 2015 convention for any attitudes. A quaternion is an aerospace attitude: it takes vectors
/// from the inertial axes into the body's, v_body = R(q) v_inertial. The object stands at the
/// inertial frame's zero, the sensor at (0, 0, -D), so that
///   p_inertial = R(q_model)^T p_object
///   p_sensor   = R(q_camera) (p_inertial + (0, 0, D))      in the legacy sensor frame.
/// The world frame here is that inertial frame; at q_camera = 1 its axes are x left, y up,
/// z forward.
Pose legacy_world_from_object(const Eigen::Quaterniond& model_q);
Pose legacy_world_from_optical(const Eigen::Quaterniond& camera_q, double distance_m);
/// The same for any translation in place of (0, 0, D).
Pose legacy_world_from_optical(const Eigen::Quaterniond& camera_q,
                               const Eigen::Vector3d& translation_m);

/// Applies --scale, --model-q and --model-r to the scene's instance; throws Error when one is given
/// and the scene has several.
void pose_model(const PoseFlags& flags, Scene& scene);

/// The sensor's pose by the flags; else `from_scene_file`; else the scene framed by these beams.
/// Throws Error when flags contradict each other.
/// A sensor whose boresight is +x (LiDAR) is aimed with it; --eye without --target leaves its axes
/// those of the world (x forward, z up), and the framing leaves it upright. A camera with --eye
/// alone looks at the middle of the box around the scene.
Pose pose_sensor(const PoseFlags& flags, const ScenePose& from_scene_file, const Beams& beams,
                 const Scene& scene);

/// True when any flag says where the sensor is.
bool sensor_pose_given(const PoseFlags& flags);

}  // namespace glidar::app

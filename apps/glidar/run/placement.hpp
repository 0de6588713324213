// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/motion_options.hpp>
#include <glidar/core/beams.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>

#include <optional>
#include <vector>

namespace glidar::app {

/// The sensor's pose in a scene file.
struct ScenePose {
  std::optional<Pose> world_from_sensor = {};
  bool looks_at = false;  ///< it was given by look_at, for a boresight +z
};

/// The convention of the original GLIDAR for any attitudes. A quaternion is an aerospace attitude:
/// it takes vectors from the inertial axes into the body's, v_body = R(q) v_inertial. The object is
/// at the origin of the inertial frame, the sensor at (0, 0, -D), so that
///   p_inertial = R(q_model)^T p_object
///   p_sensor   = R(q_camera) (p_inertial + (0, 0, D))      in the legacy sensor frame.
/// The world frame here is that inertial frame; at q_camera = 1 its axes are x left, y up,
/// z forward.
Pose woods2016_world_from_object(const Eigen::Quaterniond& model_q);
Pose woods2016_world_from_optical(const Eigen::Quaterniond& camera_q, double distance_m);
/// The same for any translation instead of (0, 0, D).
Pose woods2016_world_from_optical(const Eigen::Quaterniond& camera_q,
                                  const Eigen::Vector3d& translation_m);

/// Applies --scale, --model-q and --model-r to the scene's instance; throws Error when one is given
/// and the scene has several.
void pose_model(const PoseFlags& flags, Scene& scene);

/// The sensor's pose by the flags; else `from_scene_file`; else a pose from which these beams see
/// the whole scene. Throws Error when the direction up is not defined.
/// Options aim the boresight, which is +x for a LiDAR. For a LiDAR, --eye without --target keeps
/// the axes of the world (x forward, z up), and the default pose is upright. For a camera, --eye
/// without --target looks at the centre of the scene's bounding box.
Pose pose_sensor(const PoseFlags& flags, const ScenePose& from_scene_file, const Beams& beams,
                 const Scene& scene);

/// Whether any flag gives the sensor's pose.
bool sensor_pose_given(const PoseFlags& flags);

/// The sensor's trajectory by the flags: --trajectory, whose poses are world_from_sensor (optical
/// frame); or --sensor-rate from the pose at time 0; else `from_scene_file`; else a constant pose.
/// `pose_given`: an option gives the sensor's pose, which replaces the scene file's motion.
/// --sensor-rate is about the axes of the original GLIDAR's sensor: x left, y up, z forward.
/// `optical_from_sensor` is the identity for a camera.
Trajectory sensor_trajectory(const MotionFlags& flags, const Pose& world_from_sensor,
                             const Pose& optical_from_sensor, bool pose_given,
                             const std::optional<Trajectory>& from_scene_file);

/// The instances' trajectories: the scene file's, or --object-rate about the single model's own
/// axes. Throws Error when the option is given and the scene has several objects or moves them
/// itself.
std::vector<Trajectory> instance_trajectories(const MotionFlags& flags, const Scene& scene,
                                              const std::vector<Trajectory>& from_scene_file);

}  // namespace glidar::app

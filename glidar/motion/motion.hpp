// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>

#include <variant>
#include <vector>

namespace glidar {

/// Standing still.
struct ConstantPose {
  Pose pose = Pose::Identity();
};

/// A pose as a function of time.
using Trajectory = std::variant<ConstantPose>;

Pose pose_at(const Trajectory& trajectory, std::int64_t t_ns);

/// Where everything is at any time.
struct Motion {
  Trajectory world_from_sensor;
  std::vector<Trajectory> world_from_instance;  ///< one per instance of the scene
};

/// The sensor at this pose, every instance where the scene puts it.
Motion standing_still(const Scene& scene, const Pose& world_from_sensor);

/// Writes the poses of all at frame.stamp_ns into the frame.
void place(const Motion& motion, Frame& frame);

}  // namespace glidar

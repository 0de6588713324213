// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace glidar::osi {

/// A sensor whose frames are written.
struct OsiSensor {
  std::uint64_t id = 0;
  const Sensor& sensor;
  Pose rig_from_sensor = Pose::Identity();
};

/// The motion of the rig and of the scene's instances.
struct OsiMotion {
  Trajectory world_from_rig;
  std::vector<Trajectory> world_from_instance;
};

/// What is measured. The scene must outlive its users.
struct OsiRig {
  const Scene& scene;
  std::vector<OsiSensor> sensors;
  /// Empty: known only at the times of frames, by the frames' poses.
  std::optional<OsiMotion> motion = {};
};

}  // namespace glidar::osi

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/timed_poses.hpp>
#include <glidar/motion/torque_free_rotation.hpp>

#include <cstdint>
#include <variant>

namespace glidar {

/// A part fixed to a body whose motion has a closed form for one of its points only.
struct Mounted {
  std::variant<TimedPoses, TorqueFreeRotation> carrier;
  Pose carrier_from_body = Pose::Identity();
};

Pose pose_at(const Mounted& mounted, std::int64_t t_ns);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/rig_messages.hpp>

namespace glidar::app {

/// Where a run sends its frames beside files.
struct LiveOutputs {
  bool topics = false;   ///< of ROS 2
  bool packets = false;  ///< by UDP
  bool viewers = false;  ///< of the live view
  bool record = false;   ///< --record, whose replays may write samples of the IMU
};

/// Throws Error when an option of packets or messages has no effect because no output or sensor
/// uses it: --ouster-profile, --livox-data-type, and those of ROS messages.
void refuse_unused_output_options(const OutputFlags& flags, const PreparedScene& prepared,
                                  const LiveOutputs& live);

/// Throws Error when --imu is given, but no output has samples of an IMU.
void refuse_unused_imu(const RenderFlags& flags, const PreparedScene& prepared,
                       const LiveOutputs& live, PoseOrigin origin);

}  // namespace glidar::app

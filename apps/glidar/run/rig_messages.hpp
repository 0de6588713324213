// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/io/ros/rig_publisher.hpp>

#include <cstdint>
#include <memory>

namespace glidar::app {

/// Where the poses of the frames come from.
enum class PoseOrigin : std::uint8_t {
  motion,  ///< the motion of the command line or the scene file, known at all times
  frames,  ///< a simulator or a client, known at the times of frames; without samples of IMUs
};

/// The publisher of the scene's messages by the options of outputs. Sink, flags and scene must
/// outlive it. Throws Error.
std::unique_ptr<ros::RigPublisher> make_rig_publisher(ros::MessageSink& sink,
                                                      const RenderFlags& flags,
                                                      const PreparedScene& prepared,
                                                      PoseOrigin origin, bool for_viewers = false);

}  // namespace glidar::app

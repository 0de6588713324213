// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/rig_messages.hpp>

namespace glidar::app {

/// Packets of a sensor as the flags select them, with the samples of the rig's first IMU. Flags and
/// scene must outlive them.
ros::PublishedPackets packet_setup(const RenderFlags& flags, const PreparedScene& prepared,
                                   PoseOrigin origin, const ActiveSensor& active);

}  // namespace glidar::app

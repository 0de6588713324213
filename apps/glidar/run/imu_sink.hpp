// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>

#include <memory>

namespace glidar::app {

/// The samples of all IMUs until the end of the last frame, in the files of the flags, which must
/// outlive it like the scene. Throws Error when there is no IMU, or when the motion is not known.
std::unique_ptr<FrameSink> make_imu_sink(const RenderFlags& flags, const PreparedScene& prepared,
                                         PoseOrigin origin, Console& console);

}  // namespace glidar::app

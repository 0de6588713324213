// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>

#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// The bags, OSI traces and packet captures of the flags, which must outlive them like the scene.
/// No recording may replace one of the files that were read. Throws Error when a name is given
/// twice or is that of an input, or when a recording does not fit the sensors.
std::vector<std::unique_ptr<FrameSink>> make_recording_sinks(const RenderFlags& flags,
                                                             const PreparedScene& prepared,
                                                             const std::vector<std::string>& read,
                                                             PoseOrigin origin);

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/error_log.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// A capture of the packets of the only sensor that has packets. Throws Error when there is none,
/// or several.
std::unique_ptr<FrameSink> make_capture_sink(const std::string& path, const RenderFlags& flags,
                                             const PreparedScene& prepared, PoseOrigin origin);

/// Sends a sensor's packets by UDP. `speed`: how fast the time of the frames passes; 0: packets are
/// sent at once. The log must outlive it. Throws Error.
std::unique_ptr<FrameSink> make_udp_sink(const PacketTarget& target, double speed,
                                         const RenderFlags& flags, const PreparedScene& prepared,
                                         PoseOrigin origin, link::ErrorLog& errors);

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/error_log.hpp>

#include <memory>
#include <vector>

namespace glidar::app {

/// Where errors of peers, and what the user should know, are reported.
struct SinkReports {
  link::ErrorLog& errors;
  Console& console;
};

/// Sends the packets of sensors by UDP, as --udp selects them, and serves the drivers of each
/// sensor once. `speed`: how fast the time of the frames passes; 0: packets are sent at once. Flags
/// and reports must outlive them. Throws Error.
std::vector<std::unique_ptr<FrameSink>> make_udp_sinks(const StreamFlags& flags, double speed,
                                                       const PreparedScene& prepared,
                                                       PoseOrigin origin,
                                                       const SinkReports& reports);

}  // namespace glidar::app

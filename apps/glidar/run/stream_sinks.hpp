// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/error_log.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// Where the poses of a stream or a replay come from.
PoseOrigin pose_origin(const StreamFlags& flags);

/// How fast the time of the frames passes, as the flags pace them; 0: it is not related to real
/// time.
double time_speed(const StreamFlags& flags, const Sensor& first_sensor);

/// The bags, packet captures, samples of IMUs and receivers of packets of the flags, which must
/// outlive them like the scene, the log and the console. No file may replace one of those that were
/// read. Throws Error.
std::vector<std::unique_ptr<FrameSink>> make_stream_sinks(const StreamFlags& flags,
                                                          const PreparedScene& prepared,
                                                          const std::vector<std::string>& read,
                                                          link::ErrorLog& errors, Console& console);

/// How often the sinks are to be served.
std::chrono::milliseconds serve_interval(const std::vector<std::unique_ptr<FrameSink>>& sinks);

/// The columns of ground truth that the sinks need of all sensors.
HitColumnMask needed_hit_columns(const std::vector<std::unique_ptr<FrameSink>>& sinks,
                                 std::size_t sensor_count);

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/output/output.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// Where the poses of the frames come from.
enum class PoseOrigin : std::uint8_t {
  motion,  ///< the motion of the command line or the scene file, known at all times
  frames,  ///< a simulator or a client, known at the times of frames; without samples of IMUs
};

/// Where the poses of a stream or a replay come from.
PoseOrigin pose_origin(const StreamFlags& flags);

/// How fast the time of the frames passes, as the flags pace them; 0: it is not related to real
/// time.
double time_speed(const StreamFlags& flags, const Sensor& first_sensor);

/// The prepared scene for outputs, which it must outlive. Files may not replace those that were
/// read.
OutputRig output_rig(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin);

/// The bags, OSI traces, packet captures and KITTI folders of the flags. Throws Error when a name
/// is given twice or is that of an input, or when a recording does not fit the sensors.
std::vector<std::unique_ptr<Output>> open_recordings(const OutputFlags& flags,
                                                     const OutputRig& rig);

/// The samples of IMUs. Throws Error.
std::unique_ptr<Output> open_imu_outputs(const OutputFlags& flags, const OutputRig& rig,
                                         Console& console);

/// All of these, and the receivers of packets. The log must outlive them. Throws Error.
std::vector<std::unique_ptr<Output>> open_stream_outputs(const StreamFlags& flags,
                                                         const OutputRig& rig,
                                                         link::ErrorLog& errors, Console& console);

/// How often the outputs are to be served.
std::chrono::milliseconds serve_interval(const std::vector<std::unique_ptr<Output>>& outputs);

/// The columns of ground truth that the outputs need of all sensors.
HitColumnMask needed_hit_columns(const std::vector<std::unique_ptr<Output>>& outputs,
                                 std::size_t sensor_count);

/// Throws Error when a layout or a coordinate reference system is given, but no output takes one.
void check_layout(const OutputFlags& flags);

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

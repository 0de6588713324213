// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/delivery.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <glidar/output/rig_messages.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// A box around a turning VLP-16 with an IMU at 100 Hz, and its frames.
struct LiveScene {
  explicit LiveScene(const std::string& sensor = "VLP-16") {
    flags.input = "builtin:box:size=8,8,8";
    flags.sensor.file = sensor;
    flags.pose.eye_m = Eigen::Vector3d(0.5, 0.25, 0.125);
    flags.motion.sensor_rate_rad_s = Eigen::Vector3d(0.0, 0.5, 0.0);
    flags.duration_s = 0.2;
    flags.quiet = true;
    Console console(true);
    prepare_scene(flags, {}, console, prepared);
  }

  MeasuredFrame measure(std::uint32_t number) {
    const ActiveSensor& active = prepared.sensors.front();
    MeasuredFrame measured;
    measured.beams = active.simulator->beams(number);
    measured.index = number;
    measured.motion = std::make_shared<const Motion>(active.motion);
    set_frame_header(flags, prepared, active, number, measured.frame);
    HitColumnMask all = hit_columns_for(cloud_column_names());
    active.simulator->simulate(*measured.motion, all, measured.frame);
    return measured;
  }

  /// The publisher of its messages.
  std::unique_ptr<ros::RigPublisher> publisher(ros::MessageSink& sink,
                                               PoseOrigin origin = PoseOrigin::motion,
                                               bool for_viewers = false) const {
    return make_rig_publisher(sink, output_rig(flags, prepared, origin), flags.output, for_viewers);
  }

  RenderFlags flags;
  PreparedScene prepared;
};

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/ros2_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/dds/message_sink.hpp>

#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// `--ros2`: publishes the messages of all frames as topics of ROS 2.
class Ros2Sink final : public FrameSink {
 public:
  /// All must outlive it. Throws Error.
  Ros2Sink(const dds::Participant& participant, const Ros2Flags& ros2, const RenderFlags& flags,
           const PreparedScene& prepared, PoseOrigin origin);

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override;
  void write(const MeasuredFrame& measured) override;
  void finish() override;

 private:
  dds::MessageSink topics_;
  std::unique_ptr<ros::RigPublisher> publisher_;
};

}  // namespace glidar::app

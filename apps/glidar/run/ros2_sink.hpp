// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/ros2_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/dds/message_sink.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// `--ros2`: publishes the messages of all frames as topics of ROS 2.
class Ros2Sink final : public FrameSink {
 public:
  /// All must outlive it. `speed`: how fast the time of the frames passes; 0: it is not related to
  /// real time. Throws Error.
  Ros2Sink(const dds::Participant& participant, const Ros2Flags& ros2, const RenderFlags& flags,
           const PreparedScene& prepared, PoseOrigin origin, double speed);

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override;
  void write(const MeasuredFrame& measured) override;
  /// Publishes poses and samples of IMUs at their times.
  void serve() override;
  [[nodiscard]] std::chrono::milliseconds serve_interval() const override;
  void finish() override;

 private:
  dds::MessageSink topics_;
  std::unique_ptr<ros::RigPublisher> publisher_;
  double speed_;
  std::optional<std::chrono::steady_clock::time_point> last_due_;  ///< of the last frame
  std::int64_t last_stamp_ns_ = 0;                                 ///< of the last frame
};

}  // namespace glidar::app

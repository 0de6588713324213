// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/frame_arrivals.hpp>
#include <glidar/io/ros/held_messages.hpp>
#include <glidar/io/ros/message_sink.hpp>
#include <glidar/io/ros/rig_motion_publisher.hpp>
#include <glidar/io/ros/sensor_topics.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::ros {

/// Makes the messages of a rig's frames and writes them in the order in which their receivers get
/// them: clouds, scans and images of every frame; samples of IMUs; the poses of the rig at 100 Hz
/// and at the stamps of all clouds and images. docs/bags.md lists the topics. Bags and networks
/// receive the same messages.
class RigPublisher {
 public:
  /// Adds all topics to the sink, which must outlive it, and writes /tf_static. Throws Error.
  RigPublisher(MessageSink& sink, PublishedRig rig, RigPublisherOptions options = {});

  RigPublisher(const RigPublisher&) = delete;
  RigPublisher& operator=(const RigPublisher&) = delete;

  /// The cloud columns that it reads of a sensor's frames.
  [[nodiscard]] std::vector<std::string> columns(std::size_t sensor) const;
  /// The ground truth that it reads of a sensor's frames.
  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const;
  /// The topic of a sensor's clouds.
  [[nodiscard]] const std::string& cloud_topic(std::size_t sensor) const;
  /// How clouds become messages, for message_points().
  [[nodiscard]] const CloudMessageOptions& cloud_options(std::size_t sensor) const;

  /// Writes a frame's messages, and the poses and samples until then. Messages wait until no other
  /// sensor can have an earlier one, at most until the next frame. Frames are in the order of their
  /// start; earlier ones are written without poses. Throws Error.
  void publish(std::size_t sensor, const Frame& frame, const Beams& beams);
  /// Writes what receivers get until a time between frames, so that they get it evenly. It has no
  /// effect beyond the end of the frame that is expected next, or without a motion.
  void advance(std::int64_t now_ns);
  /// Writes all messages, and the poses and samples until the end of the last frame. The sink is
  /// not finished.
  void finish();

 private:
  void place_camera_without_rig();
  void release(std::int64_t until_ns);
  [[nodiscard]] bool is_wanted(const std::optional<std::size_t>& topic) const;
  [[nodiscard]] std::vector<std::string> cloud_columns(std::size_t sensor) const;
  /// Writes what is the same for all frames, when the first one starts.
  void begin(std::int64_t start_ns);
  [[nodiscard]] std::int64_t delivery_ns(std::int64_t stamp_ns, const Beams& beams,
                                         std::int64_t end_ns) const;
  template <class Message>
  void hold(std::size_t topic, std::int64_t stamp_ns, std::int64_t time_ns, const Message& message);
  void hold_cloud(std::size_t sensor, const CloudSource& source, std::int64_t end_ns);
  void hold_scan(const SensorTopics& topics, const CloudSource& source, std::int64_t end_ns);
  void hold_images(const SensorTopics& topics, const CloudSource& source, std::int64_t end_ns);

  MessageSink& sink_;
  PublishedRig rig_;
  RigPublisherOptions options_;
  std::vector<SensorTopics> topics_;  ///< per sensor
  std::optional<RigMotionPublisher> motion_;
  FrameArrivals arrivals_;
  HeldMessages held_;
  TFMessage static_transforms_;
  std::optional<std::size_t> static_topic_;  ///< empty: there is no such transform
  std::optional<std::int64_t> end_ns_;       ///< of the last frame; empty: there was none
  PointCloud cloud_;
};

}  // namespace glidar::ros

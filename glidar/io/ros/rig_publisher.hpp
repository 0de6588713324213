// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/frame_arrivals.hpp>
#include <glidar/io/ros/held_messages.hpp>
#include <glidar/io/ros/image_transport.hpp>
#include <glidar/io/ros/message_sink.hpp>
#include <glidar/io/ros/packet_topics.hpp>
#include <glidar/io/ros/published_rig.hpp>
#include <glidar/io/ros/rig_motion_publisher.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::ros {

struct RigPublisherOptions {
  std::string layout = {};                ///< of points, see cloud_layouts(); empty: `columns`
  std::vector<std::string> columns = {};  ///< of points; empty: those that suit the sensor
  bool deskew = false;                    ///< points as fired from where the sensor was
  ImageTransport images = ImageTransport::raw;
  /// For viewers: points have their true range, and sensors with rows and columns have images of
  /// their intensity, and scanners of their range.
  bool for_viewers = false;
};

/// Makes the messages of a rig's frames and writes them in the order of their stamps: clouds, scans
/// and images of every frame; samples of IMUs; /tf, /odom and /clock at 100 Hz and at the time of
/// every frame. docs/bags.md lists the topics. Bags and networks receive the same messages.
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
  [[nodiscard]] CloudMessageOptions cloud_options(std::size_t sensor) const;

  /// Writes a frame's messages, and the poses and samples until then. Messages wait until no other
  /// sensor can have an earlier one, at most until the next frame. Frames are in the order of their
  /// start; earlier ones are written without poses. Throws Error.
  void publish(std::size_t sensor, const Frame& frame, const Beams& beams);
  /// Writes the poses and samples until a time between frames, so that receivers get them evenly.
  /// It has no effect beyond the end of the frame that is expected next, or without a motion.
  void advance(std::int64_t now_ns);
  /// Writes the poses and samples until the end of the last frame. The sink is not finished.
  void finish();

 private:
  /// The topics of a sensor, by their number in the sink.
  struct SensorTopics {
    std::string frame_id;
    std::string cloud_name;
    std::size_t cloud = 0;
    std::optional<std::size_t> scan = {};                  ///< of scanners with one ring
    std::optional<std::size_t> depth = {};                 ///< of cameras
    std::optional<std::size_t> compressed_depth = {};      ///< of cameras
    std::optional<std::size_t> compressed_intensity = {};  ///< of cameras
    std::optional<std::size_t> camera_info = {};           ///< of cameras
    std::optional<std::size_t> range = {};                 ///< of scanners with rows, for viewers
    std::optional<std::size_t> intensity = {};             ///< for viewers
    std::optional<std::size_t> boxes = {};                 ///< in scenes with classes
    std::unique_ptr<PacketTopics> packets = {};
  };

  void release(std::int64_t until_ns);
  [[nodiscard]] bool is_wanted(const std::optional<std::size_t>& topic) const;
  [[nodiscard]] bool has_custom_msg() const { return options_.layout == kCustomMsgLayout; }
  [[nodiscard]] std::vector<std::string> cloud_columns(std::size_t sensor) const;
  SensorTopics add_topics(const PublishedSensor& sensor);
  void add_image_topics(const PublishedSensor& sensor, const std::string& base,
                        SensorTopics& topics);
  /// Writes what is the same for all frames, when the first one starts.
  void begin(std::int64_t start_ns);
  void write_static_transforms(std::int64_t t_ns);
  void hold_cloud(std::size_t sensor, const CloudSource& source, std::int64_t stamp_ns);
  void hold_compressed_images(const SensorTopics& topics, const CloudSource& source,
                              std::int64_t stamp_ns);
  void hold_images(const SensorTopics& topics, const CloudSource& source, std::int64_t stamp_ns);

  MessageSink& sink_;
  PublishedRig rig_;
  RigPublisherOptions options_;
  std::vector<SensorTopics> topics_;  ///< per sensor
  std::optional<RigMotionPublisher> motion_;
  FrameArrivals arrivals_;
  HeldMessages held_;
  std::size_t static_topic_ = 0;        ///< transforms that do not change
  std::optional<std::int64_t> end_ns_;  ///< of the last frame; empty: there was none
  PointCloud cloud_;
};

}  // namespace glidar::ros

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/driver.hpp>
#include <glidar/io/ros/held_messages.hpp>
#include <glidar/io/ros/image_transport.hpp>
#include <glidar/io/ros/message_sink.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/io/ros/published_rig.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

/// Publishes the packets of a sensor as the driver of its manufacturer does: those of Ouster one by
/// one, and those of Velodyne as a VelodyneScan for each frame.
class PacketTopics {
 public:
  /// Adds the topics to the sink, which must outlive it. `base` is before the names of all topics.
  /// Throws Error when the sensor has no packets of these manufacturers.
  PacketTopics(MessageSink& sink, const PublishedSensor& sensor, const std::string& base,
               std::string frame_id);

  /// Adds the packets that a frame completes to the messages that are to be written.
  void hold(const Frame& frame, const Beams& beams, HeldMessages& held);
  /// The same for the last packet, filled with firings without returns.
  void finish(HeldMessages& held);

 private:
  void hold_packets(HeldMessages& held);
  void hold_scan(HeldMessages& held);

  MessageSink& sink_;
  std::string frame_id_;
  SensorPackets packets_;
  bool is_from_ouster_;
  std::uint16_t imu_port_;
  std::size_t packets_topic_ = 0;
  std::size_t imu_topic_ = 0;  ///< Ouster
  std::vector<UdpPacket> made_;
};

/// The driver of a sensor.
struct DriverChoice {
  std::string sensor_name;  ///< on the rig; empty: all that the driver suits
  const Driver* driver = nullptr;
};

struct RigPublisherOptions {
  std::string layout = {};                ///< of points, see cloud_layouts(); empty: `columns`
  std::vector<std::string> columns = {};  ///< of points; empty: those that suit the sensor
  bool deskew = false;                    ///< points as fired from where the sensor was
  ImageTransport images = ImageTransport::raw;
  bool has_colour = true;    ///< of cameras; the frames must have the column colour
  bool depth_in_mm = false;  ///< raw depth images of own topics are 16UC1 instead of 32FC1
  /// For viewers: points have their true range, and sensors with rows and columns have images of
  /// their intensity, and scanners of their range. Drivers have no effect.
  bool for_viewers = false;
  /// Messages are written when a driver has them: those of a scan at its end. False: as soon as
  /// the frame is known.
  bool has_latency = true;
  std::vector<DriverChoice> drivers = {};
  TransformOptions transforms = {};
  bool has_imu_orientation = false;  ///< the true one; else it is marked as absent
};

struct ImageTopic {
  const ImageStream* stream = nullptr;
  std::string frame_id = {};
  std::string info_frame_id = {};
  std::optional<std::size_t> raw = {};
  std::optional<std::size_t> compressed = {};
  std::optional<std::size_t> info = {};
};

/// The topics of a sensor, by their number in the sink.
struct SensorTopics {
  const Driver* driver = nullptr;
  std::string name = {};    ///< for % in names
  std::string prefix = {};  ///< of the driver's names, if several sensors have it
  std::string frame_id = {};
  std::string cloud_name = {};
  CloudMessageOptions cloud_options = {};
  Pose rig_from_published = Pose::Identity();  ///< of frame_id
  std::optional<std::size_t> cloud = {};
  std::optional<std::size_t> scan = {};
  std::vector<ImageTopic> images = {};
  std::optional<std::size_t> boxes = {};  ///< in scenes with classes
  std::unique_ptr<PacketTopics> packets = {};
  std::optional<std::size_t> metadata = {};  ///< of Ouster sensors
  String metadata_text = {};
};

/// An IMU's topic and format; empty format: GLIDAR's own.
struct ImuTopicChoice {
  std::string topic;
  std::string frame_id;
  const ImuFormat* format = nullptr;
  std::optional<std::size_t> sensor = {};  ///< whose driver publishes it
  /// From the axes of the IMU to those of `frame_id`.
  Eigen::Matrix3d published_from_imu = Eigen::Matrix3d::Identity();
};

[[nodiscard]] bool is_camera(const Sensor& sensor);
[[nodiscard]] bool is_depth(ImageContent content);
[[nodiscard]] bool is_colour(ImageContent content);

/// Adds the topics of all sensors to a sink. Throws Error, naming --as, for a driver without a
/// sensor that it suits.
std::vector<SensorTopics> add_sensor_topics(MessageSink& sink, const PublishedRig& rig,
                                            const RigPublisherOptions& options);

/// The topics of the rig's IMUs. The first IMU is that of the first driver that publishes one.
std::vector<ImuTopicChoice> imu_topics(const PublishedRig& rig,
                                       const std::vector<SensorTopics>& topics,
                                       const TransformOptions& options);

/// /tf_static: the rig's sensors and IMUs, and the frames of drivers.
TFMessage static_transforms(const PublishedRig& rig, const std::vector<SensorTopics>& topics,
                            const std::vector<ImuTopicChoice>& imus,
                            const TransformOptions& options);

}  // namespace glidar::ros

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/memory_pool.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/codec.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/io/ros/published_rig.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::ros {

/// When the next frames of a rig can begin. Its frames arrive in the order of their start.
class FrameArrivals {
 public:
  /// `is_periodic`: every frame begins where the last one of its sensor ends. Otherwise each pose
  /// gives one frame of every sensor, at times that are not known before.
  FrameArrivals(std::size_t sensors, bool is_periodic)
      : sensors_(sensors), is_periodic_(is_periodic) {}

  /// A frame that began at `start_ns`. Its sensor measures for `duration_ns`. False if it is
  /// earlier than the last frame, as after a step back in a recording.
  bool add(std::size_t sensor, std::int64_t start_ns, std::int64_t duration_ns);

  /// No frame that arrives later begins before this time.
  [[nodiscard]] std::int64_t complete_ns() const;
  /// The first end of the frames that are expected next; empty before the first frame.
  [[nodiscard]] std::optional<std::int64_t> next_end_ns() const;

 private:
  struct SensorFrames {
    std::optional<std::int64_t> start_ns = {};  ///< of its last frame
    std::int64_t next_start_ns = 0;
    std::int64_t next_end_ns = 0;
  };

  std::vector<SensorFrames> sensors_;
  bool is_periodic_;
  std::optional<std::int64_t> last_start_ns_;
};

/// Serialized messages that wait for earlier ones, by time; those of one time stay in their order.
class HeldMessages {
 public:
  struct Held {
    std::int64_t time_ns = 0;
    std::optional<std::size_t> topic;  ///< empty: only a time
    std::vector<std::byte> bytes;
  };

  /// The memory of a message that was written, for later ones.
  void give_back(std::vector<std::byte> memory) { written_.give_back(std::move(memory)); }

  void hold(Held message);
  /// Serializes a message.
  template <class Message>
  void hold(std::size_t topic, std::int64_t time_ns, const Message& message) {
    std::size_t size = 0;
    if constexpr (requires { message.data.size(); }) size = message.data.size();
    std::vector<std::byte> bytes = written_.take(size);
    serialize_to(message, bytes);
    hold({.time_ns = time_ns, .topic = topic, .bytes = std::move(bytes)});
  }
  /// Removes the first message if its time is at most `until_ns`.
  std::optional<Held> release(std::int64_t until_ns);

 private:
  std::deque<Held> held_;
  MemoryPool written_;
};

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

/// Pixels of a depth image. REP-118: 16UC1 is millimetres and 0 without a return, 32FC1 is metres
/// and NaN without one.
enum class DepthEncoding : std::uint8_t { millimetres_16uc1, metres_32fc1 };

/// The depth along the boresight; of a camera that looks back, the range along the beams.
/// `frame_id` empty: that of the sensor. Depths above 65.535 m are 0 in 16UC1. Throws Error for
/// sensors that report several returns or depths behind them.
Image depth_image(const CloudSource& source, DepthEncoding encoding,
                  const std::string& frame_id = {});

/// Pixels of an intensity image.
enum class IntensityEncoding : std::uint8_t {
  mono8,   ///< 0 to 1 as 0 to 255, clipped
  mono16,  ///< 0 to 1 as 0 to 65535, clipped
  f32c1,   ///< 32FC1, the intensity itself
};

/// Rows and columns of the first return.
Image intensity_image(const CloudSource& source, IntensityEncoding encoding,
                      const std::string& frame_id = {});

/// Rows and columns of the first return: 32FC1, the reported range in metres, NaN without a return.
Image range_image(const CloudSource& source, const std::string& frame_id = {});

/// Channels of a colour image.
enum class ColourEncoding : std::uint8_t { rgb8, bgra8 };

/// The diffuse colours of the surfaces, black where there is none. Throws Error if the frame was
/// cast without colours.
Image colour_image(const CloudSource& source, ColourEncoding encoding,
                   const std::string& frame_id = {});

/// One of Frame::raw_images: mono8, or mono16 if it has more than 8 bits. Throws Error if there is
/// none of this name.
Image raw_image(const CloudSource& source, std::string_view name, const std::string& frame_id = {});

/// What the images of Ouster's driver show.
enum class OusterChannel : std::uint8_t { range, signal, reflectivity, near_infrared };

/// An image of Ouster's driver: mono16, each row shifted so that columns have one azimuth. Range is
/// in steps of 4 mm, 0 beyond 16 bits. The others are scaled so that their 10th and 90th percentile
/// are at 0.1 and 0.9, and of signal and near infrared the square root is taken.
Image ouster_image(const CloudSource& source, OusterChannel channel,
                   const std::string& frame_id = {});

/// An image of encoding mono8, 16UC1 or rgb8 as PNG, in the format of image_transport's plugin
/// compressed_image_transport. Throws Error for other encodings.
CompressedImage png_image(const Image& image);

/// A depth image of encoding 16UC1 in the format of image_transport's plugin
/// compressed_depth_image_transport: PNG behind a header of 12 bytes. Throws Error for other
/// encodings.
CompressedImage compressed_depth_image(const Image& image);

/// Intrinsics and distortion. `right_baseline_m`: of the right camera of a stereo pair at this
/// distance, whose P[3] is -fx times it (sensor_msgs/CameraInfo). Throws Error for optics other
/// than a camera.
CameraInfo camera_info(const CloudSource& source, const std::string& frame_id = {},
                       double right_baseline_m = 0.0);

/// The beams of one ring as a scan in the plane of the sensor's axes ahead and left: angles grow
/// counter-clockwise, those of a whole turn from -pi on, and ranges are distances in that plane.
/// The stamp is the time of the first firing, and time_increment is positive, as of all drivers,
/// also of scanners that turn clockwise, whose greatest angles fire first. REP-117: +inf without a
/// return, -inf for surfaces that are too near, NaN for invalid measurements. Throws Error when the
/// ring has fewer than two beams or its angles are not equally spaced.
/// `quarter_turns` of the axes: see quarter_turned().
LaserScan laser_scan(const CloudSource& source, std::uint16_t ring,
                     const std::string& frame_id = {}, int quarter_turns = 0);

// Scans as the drivers of manufacturers make them: docs/drivers.md.

/// The nearly level ring in bins of 0.007 rad: ros-drivers/velodyne (04a7ca7),
/// velodyne_laserscan.cpp.
LaserScan velodyne_scan(const CloudSource& source, std::int64_t stamp_ns,
                        const std::string& frame_id);

/// The highest row, in reverse: ouster-lidar/ouster-ros (f5c4ef8), os_ros.cpp.
LaserScan ouster_scan(const CloudSource& source, std::int64_t stamp_ns,
                      const std::string& frame_id);

/// All returns in bins of equal angles, in reverse: Slamtec/sllidar_ros2 (3430009),
/// sllidar_node.cpp with angle_compensate.
LaserScan rplidar_scan(const CloudSource& source, std::int64_t stamp_ns,
                       const std::string& frame_id);

}  // namespace glidar::ros

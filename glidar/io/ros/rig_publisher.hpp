// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/message_sink.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/imu/imu_samples.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glidar::ros {

/// A sensor whose frames are published. Sensor and beams must outlive the publisher.
struct PublishedSensor {
  std::string name;  ///< on the rig; empty: the only sensor
  const Sensor& sensor;
  const Beams& beams;  ///< of frame 0
  Pose rig_from_sensor = Pose::Identity();
};

/// An IMU whose samples are published.
struct PublishedImu {
  std::string name;
  Pose rig_from_imu = Pose::Identity();
};

/// The samples of an IMU, by index, with from_ns <= t < until_ns.
using ImuSampler =
    std::function<ImuSamples(std::size_t imu, std::int64_t from_ns, std::int64_t until_ns)>;

/// What is published. The scene must outlive the publisher.
struct PublishedRig {
  const Scene& scene;
  std::vector<PublishedSensor> sensors;
  /// The motion of the rig; empty: known only at the times of frames, by the frames' poses.
  std::optional<Trajectory> world_from_rig = {};
  std::vector<PublishedImu> imus = {};  ///< only with world_from_rig
  ImuSampler imu_samples = {};
};

struct RigPublisherOptions {
  std::string layout = {};                ///< of points, see cloud_layouts(); empty: `columns`
  std::vector<std::string> columns = {};  ///< of points; empty: those that suit the sensor
  bool deskew = false;                    ///< points as fired from where the sensor was
  /// For viewers: points have their true range, and sensors with rows and columns have images of
  /// their intensity, and scanners of their range.
  bool for_viewers = false;
};

/// Makes the messages of a rig's frames and writes them in the order of time: clouds, scans and
/// images of every frame; samples of IMUs; /tf, /odom and /clock at 100 Hz and at the time of every
/// frame. docs/bags.md lists the topics. Bags and networks receive the same messages.
class RigPublisher {
 public:
  /// Adds all topics to the sink, which must outlive it, and writes /tf_static. Throws Error.
  RigPublisher(MessageSink& sink, PublishedRig rig, RigPublisherOptions options = {});

  /// The cloud columns that it reads of a sensor's frames.
  [[nodiscard]] std::vector<std::string> columns(std::size_t sensor) const;
  /// The ground truth that it reads of a sensor's frames.
  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const;
  /// The topic of a sensor's clouds.
  [[nodiscard]] const std::string& cloud_topic(std::size_t sensor) const;
  /// How clouds become messages, for message_points().
  [[nodiscard]] CloudMessageOptions cloud_options(std::size_t sensor) const;

  /// Writes the poses and samples until a frame, and its messages. Frames are in the order of their
  /// start; earlier ones are written without poses. Throws Error.
  void publish(std::size_t sensor, const Frame& frame, const Beams& beams);
  /// Writes the poses and samples until the end of the last frame. The sink is not finished.
  void finish();

 private:
  /// The topics of a sensor, by their number in the sink.
  struct SensorTopics {
    std::string frame_id;
    std::string cloud_name;
    std::size_t cloud = 0;
    std::optional<std::size_t> scan = {};         ///< of scanners with one ring
    std::optional<std::size_t> depth = {};        ///< of cameras
    std::optional<std::size_t> camera_info = {};  ///< of cameras
    std::optional<std::size_t> range = {};        ///< of scanners with rows, for viewers
    std::optional<std::size_t> intensity = {};    ///< for viewers
    std::optional<std::size_t> boxes = {};        ///< in scenes with classes
  };
  /// An IMU and the samples that were computed but not yet written.
  struct ImuTopic {
    std::size_t topic = 0;
    std::int64_t computed_ns = 0;  ///< until this time
    ImuSamples samples = {};
    std::size_t next = 0;  ///< of the samples
  };
  struct RigPose {
    std::int64_t t_ns = 0;
    Pose world_from_rig = Pose::Identity();
  };

  template <class Message>
  void write(std::size_t topic, std::int64_t time_ns, const Message& message);
  [[nodiscard]] bool is_wanted(const std::optional<std::size_t>& topic) const;
  [[nodiscard]] bool has_custom_msg() const { return options_.layout == kCustomMsgLayout; }
  [[nodiscard]] std::vector<std::string> cloud_columns(std::size_t sensor) const;
  SensorTopics add_topics(const PublishedSensor& sensor);
  void write_static_transforms();
  void write_cloud(std::size_t sensor, const CloudSource& source, std::int64_t stamp_ns);
  void write_images(const SensorTopics& topics, const CloudSource& source, std::int64_t stamp_ns);
  void advance(std::int64_t until_ns);
  void skip_gap(std::int64_t until_ns);
  void write_motion_pose(std::int64_t t_ns);
  void write_frame_pose(std::size_t sensor, const Frame& frame);
  void write_pose(std::int64_t t_ns, const TFMessage& transforms, const Odometry& odometry);
  void compute_imu_samples(std::int64_t until_ns);
  void write_imu_samples(std::size_t imu, std::int64_t until_ns);

  MessageSink& sink_;
  PublishedRig rig_;
  RigPublisherOptions options_;
  std::vector<SensorTopics> topics_;  ///< per sensor
  std::vector<ImuTopic> imus_;        ///< per IMU
  std::size_t tf_ = 0;
  std::size_t odometry_ = 0;
  std::size_t clock_ = 0;
  std::int64_t next_pose_ns_ = 0;             ///< of those at 100 Hz
  std::optional<std::int64_t> last_pose_ns_;  ///< that was written
  std::optional<RigPose> last_frame_pose_;    ///< without a motion
  std::int64_t end_ns_ = 0;                   ///< of the last frame
  PointCloud cloud_;
  std::vector<std::byte> bytes_;
};

}  // namespace glidar::ros

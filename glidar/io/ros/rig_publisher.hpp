// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/codec.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/io/ros/published_rig.hpp>
#include <glidar/io/ros/sensor_topics.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace glidar::ros {

/// Writes the poses of a rig as /tf, odometry and /clock, and the samples of its IMUs, in the order
/// of time.
class RigMotionPublisher {
 public:
  /// Adds the topics to the sink. Both must outlive it. Throws Error.
  RigMotionPublisher(MessageSink& sink, const PublishedRig& rig, TransformOptions options,
                     const std::vector<ImuTopicChoice>& imus, bool has_imu_orientation);

  /// The time from which poses count, at or before all others.
  void begin(std::int64_t start_ns) { start_ns_ = start_ns; }
  /// With a motion: writes everything until a time, and the pose at it. If this time has passed, it
  /// only writes the pose, and no time of the clock.
  void advance(std::int64_t until_ns);
  /// The same without a pose of its own at this time. It has no effect before the first advance().
  void advance_between(std::int64_t until_ns);
  /// Without a motion: writes the pose of a frame, with the mean velocity since the last one.
  void write_frame_pose(std::size_t sensor, const Frame& frame);
  /// Whether a pose was written.
  [[nodiscard]] bool has_begun() const { return last_pose_ns_.has_value(); }

 private:
  /// An IMU and the samples that were computed but not yet written.
  struct ImuTopic {
    std::size_t topic = 0;
    std::string frame_id;
    const ImuFormat* format = nullptr;
    Eigen::Matrix3d published_from_imu = Eigen::Matrix3d::Identity();
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
  void write_until(std::int64_t until_ns);
  void skip_gap(std::int64_t until_ns);
  void write_motion_pose(std::int64_t t_ns);
  void write_passed_pose(std::int64_t t_ns);
  void write_transform(const Pose& world_from_rig, const std::optional<BodyTwist>& twist,
                       std::int64_t t_ns);
  void write_clock(std::int64_t t_ns);
  void compute_imu_samples(std::int64_t until_ns);
  void write_imu_samples(std::int64_t until_ns);
  void write_imu_sample(std::size_t imu);

  MessageSink& sink_;
  const PublishedRig& rig_;
  TransformOptions options_;
  bool has_imu_orientation_;
  std::size_t tf_ = 0;
  std::size_t odometry_ = 0;
  std::size_t clock_ = 0;
  std::vector<ImuTopic> imus_;                ///< per IMU of a rig with a motion
  std::int64_t start_ns_ = 0;                 ///< of poses at 100 Hz
  std::int64_t next_pose_ns_ = 0;             ///< of those at 100 Hz
  std::optional<std::int64_t> last_pose_ns_;  ///< that was written
  std::int64_t reached_ns_ = 0;               ///< all is written until this time
  std::deque<std::int64_t> pose_times_ns_;    ///< of the last poses
  std::optional<Pose> world_from_start_;      ///< level, for TransformMode::odom
  std::optional<RigPose> last_frame_pose_;    ///< without a motion
  std::vector<std::byte> bytes_;
};

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

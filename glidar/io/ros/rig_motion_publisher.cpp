// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_motion_publisher.hpp>

#include <glidar/motion/kinematics.hpp>

namespace glidar::ros {
namespace {

/// From one pose of the rig to the next in /tf, /odom and /clock: 100 Hz.
constexpr std::int64_t kPosePeriod_ns = 10'000'000;

/// Longer times between frames have no poses and samples.
constexpr std::int64_t kMaxGap_ns = 1'000'000'000'000;

Vector3 vector_message(const Eigen::Vector3d& v) {
  return {.x = v.x(), .y = v.y(), .z = v.z()};
}

}  // namespace

RigMotionPublisher::RigMotionPublisher(MessageSink& sink, const PublishedRig& rig)
    : sink_(sink), rig_(rig) {
  tf_ = sink_.add_topic(make_topic<TFMessage>("/tf"));
  odometry_ = sink_.add_topic(make_topic<Odometry>("/odom"));
  clock_ = sink_.add_topic(make_topic<Clock>("/clock"));
  for (const PublishedImu& imu : rig_.imus) {
    imus_.push_back({.topic = sink_.add_topic(make_topic<Imu>("/" + imu.name + "/data"))});
  }
}

template <class Message>
void RigMotionPublisher::write(std::size_t topic, std::int64_t time_ns, const Message& message) {
  serialize_to(message, sink_.wire(), bytes_);
  sink_.write(topic, time_ns, bytes_);
}

void RigMotionPublisher::advance(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns < reached_ns_) return;
  skip_gap(until_ns);
  write_until(until_ns);
  if (last_pose_ns_ != until_ns) write_motion_pose(until_ns);
}

void RigMotionPublisher::advance_between(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns > reached_ns_ && until_ns - reached_ns_ <= kMaxGap_ns)
    write_until(until_ns);
}

void RigMotionPublisher::write_until(std::int64_t until_ns) {
  compute_imu_samples(until_ns + 1);
  for (; next_pose_ns_ <= until_ns; next_pose_ns_ += kPosePeriod_ns) {
    write_imu_samples(next_pose_ns_);
    if (last_pose_ns_ != next_pose_ns_) write_motion_pose(next_pose_ns_);
  }
  write_imu_samples(until_ns + 1);
  reached_ns_ = until_ns;
}

/// Begins at the first frame, and again after a gap in time, such as of an edited recording.
void RigMotionPublisher::skip_gap(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns - reached_ns_ <= kMaxGap_ns) return;
  next_pose_ns_ = until_ns - (until_ns - start_ns_) % kPosePeriod_ns;
  for (ImuTopic& imu : imus_) {
    imu.computed_ns = next_pose_ns_;
    imu.samples = {};
    imu.next = 0;
  }
}

void RigMotionPublisher::write_motion_pose(std::int64_t t_ns) {
  const KinematicState state = state_at(*rig_.world_from_rig, t_ns);
  const Eigen::Matrix3d rig_from_world = state.pose.linear().transpose();
  const FramePair frames{kMapFrame, kRigFrame};
  write_pose(t_ns, {.transforms = {to_transform(state.pose, frames, t_ns)}},
             to_odometry(state.pose,
                         BodyTwist{.linear_m_s = rig_from_world * state.velocity_m_s,
                                   .angular_rad_s = state.angular_velocity_rad_s},
                         frames, t_ns));
}

void RigMotionPublisher::write_frame_pose(std::size_t sensor, const Frame& frame) {
  const std::int64_t t_ns = frame.stamp_ns;
  if (last_frame_pose_ && last_frame_pose_->t_ns == t_ns && last_pose_ns_ == t_ns) return;
  const Pose pose = frame.world_from_sensor * rig_.sensors[sensor].rig_from_sensor.inverse();
  std::optional<BodyTwist> twist;
  if (last_frame_pose_ && last_frame_pose_->t_ns < t_ns) {
    constexpr double kNanosecond_s = 1e-9;
    const double seconds = kNanosecond_s * static_cast<double>(t_ns - last_frame_pose_->t_ns);
    twist = mean_twist(last_frame_pose_->world_from_rig, pose, seconds);
  }
  last_frame_pose_ = RigPose{t_ns, pose};
  const FramePair frames{kMapFrame, kRigFrame};
  write_pose(t_ns, {.transforms = {to_transform(pose, frames, t_ns)}},
             to_odometry(pose, twist, frames, t_ns));
}

void RigMotionPublisher::write_pose(std::int64_t t_ns, const TFMessage& transforms,
                                    const Odometry& odometry) {
  write(tf_, t_ns, transforms);
  write(odometry_, t_ns, odometry);
  write(clock_, t_ns, to_clock(t_ns));
  last_pose_ns_ = t_ns;
}

void RigMotionPublisher::compute_imu_samples(std::int64_t until_ns) {
  for (std::size_t i = 0; i < imus_.size(); ++i) {
    ImuTopic& imu = imus_[i];
    if (until_ns <= imu.computed_ns) continue;
    imu.samples = rig_.imu_samples(i, imu.computed_ns, until_ns);
    imu.computed_ns = until_ns;
    imu.next = 0;
  }
}

/// Those of all IMUs, in the order of time.
void RigMotionPublisher::write_imu_samples(std::int64_t until_ns) {
  for (;;) {
    std::optional<std::size_t> first;
    std::int64_t first_ns = until_ns;
    for (std::size_t i = 0; i < imus_.size(); ++i) {
      const ImuTopic& imu = imus_[i];
      if (imu.next == imu.samples.t_ns.size() || imu.samples.t_ns[imu.next] >= first_ns) continue;
      first = i;
      first_ns = imu.samples.t_ns[imu.next];
    }
    if (!first) return;
    write_imu_sample(*first);
  }
}

void RigMotionPublisher::write_imu_sample(std::size_t index) {
  ImuTopic& imu = imus_[index];
  const std::size_t sample = imu.next++;
  const std::int64_t t_ns = imu.samples.t_ns[sample];
  Imu message;
  message.header = {.stamp = time_from_ns(t_ns), .frame_id = rig_.imus[index].name};
  message.orientation_covariance[0] = -1.0;  // no orientation: sensor_msgs/Imu
  message.angular_velocity = vector_message(imu.samples.angular_velocity_rad_s[sample]);
  message.linear_acceleration = vector_message(imu.samples.specific_force_m_s2[sample]);
  write(imu.topic, t_ns, message);
}

}  // namespace glidar::ros

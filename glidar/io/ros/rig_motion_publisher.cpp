// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/rig_motion_publisher.hpp>

#include <glidar/motion/kinematics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glidar::ros {
namespace {

/// From one pose of the rig to the next in /tf, /odom and /clock: 100 Hz.
constexpr std::int64_t kPosePeriod_ns = 10'000'000;

/// Longer times between frames have no poses and samples.
constexpr std::int64_t kMaxGap_ns = 1'000'000'000'000;

/// Of an orientation without error, rad^2: all zeros would mean that it is not known.
constexpr double kExactVariance = 1e-9;

std::array<double, 9> same_variances(double variance) {
  return {variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, variance};
}

/// Of the white noise of samples: N^2 times the rate (kalibr, "IMU Noise Model").
double white_variance(const InertialTriad& triad, const glidar::Imu& imu) {
  return triad.noise_density * triad.noise_density * imu.rate_hz;
}

/// The same position and heading, with z up.
Pose level_pose(const Pose& pose) {
  Pose level = Pose::Identity();
  level.translation() = pose.translation();
  const double x = pose.linear()(0, 0);
  const double y = pose.linear()(1, 0);
  const double length = std::sqrt(x * x + y * y);
  constexpr double kUpright = 1e-9;  // x points up or down: no heading
  if (length > kUpright)
    level.linear().topLeftCorner<2, 2>() << x / length, -y / length, y / length, x / length;
  return level;
}

Vector3 vector_message(const Eigen::Vector3d& v) {
  return {.x = v.x(), .y = v.y(), .z = v.z()};
}

}  // namespace

RigMotionPublisher::RigMotionPublisher(MessageSink& sink, const PublishedRig& rig,
                                       TransformOptions options,
                                       const std::vector<ImuTopicChoice>& imus,
                                       bool has_imu_orientation)
    : sink_(sink),
      rig_(rig),
      options_(std::move(options)),
      has_imu_orientation_(has_imu_orientation) {
  if (options_.mode != TransformMode::none) {
    const bool is_own = options_.mode == TransformMode::ground_truth;
    tf_ = sink_.add_topic(make_topic<TFMessage>("/tf"));
    odometry_ = sink_.add_topic(make_topic<Odometry>(is_own ? "/ground_truth/odom" : "/odom"));
  }
  clock_ = sink_.add_topic(make_topic<Clock>("/clock"));
  for (const ImuTopicChoice& choice : imus) {
    Topic topic = make_topic<Imu>(choice.topic);
    if (choice.format != nullptr) topic.qos = choice.format->qos;
    imus_.push_back({.topic = sink_.add_topic(topic),
                     .frame_id = choice.frame_id,
                     .format = choice.format,
                     .published_from_imu = choice.published_from_imu});
  }
}

template <class Message>
void RigMotionPublisher::write(std::size_t topic, std::int64_t time_ns, const Message& message) {
  serialize_to(message, sink_.wire(), bytes_);
  sink_.write(topic, time_ns, bytes_);
}

void RigMotionPublisher::advance(std::int64_t until_ns) {
  if (last_pose_ns_ && until_ns < reached_ns_) return write_passed_pose(until_ns);
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

/// The pose at a time that the clock has passed. Receivers of transforms sort them by their stamps.
void RigMotionPublisher::write_passed_pose(std::int64_t t_ns) {
  const bool is_known =
      std::find(pose_times_ns_.begin(), pose_times_ns_.end(), t_ns) != pose_times_ns_.end();
  if (!is_known && reached_ns_ - t_ns <= kMaxGap_ns) write_motion_pose(t_ns);
}

void RigMotionPublisher::write_motion_pose(std::int64_t t_ns) {
  const KinematicState state = state_at(*rig_.world_from_rig, t_ns);
  const Eigen::Matrix3d rig_from_world = state.pose.linear().transpose();
  write_transform(state.pose,
                  BodyTwist{.linear_m_s = rig_from_world * state.velocity_m_s,
                            .angular_rad_s = state.angular_velocity_rad_s},
                  t_ns);
  write_clock(t_ns);
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
  last_pose_ns_.reset();  // recordings may step back
  write_transform(pose, twist, t_ns);
  write_clock(t_ns);
}

void RigMotionPublisher::write_transform(const Pose& world_from_rig,
                                         const std::optional<BodyTwist>& twist, std::int64_t t_ns) {
  if (!world_from_start_) world_from_start_ = level_pose(world_from_rig);
  if (options_.mode == TransformMode::none) return;
  const bool is_truth = options_.mode == TransformMode::ground_truth;
  const bool is_odom = options_.mode == TransformMode::odom;
  const std::string rig = options_.prefix + kRigFrame;
  const std::string fixed = is_truth  ? options_.prefix + kGroundTruthFrame
                            : is_odom ? options_.prefix + kOdometryFrame
                                      : kMapFrame;
  const Pose pose = is_odom ? Pose(world_from_start_->inverse() * world_from_rig) : world_from_rig;
  const TransformStamped transform = is_truth ? to_transform(pose.inverse(), {rig, fixed}, t_ns)
                                              : to_transform(pose, {fixed, rig}, t_ns);
  const std::int64_t time_ns = last_pose_ns_ ? std::max(t_ns, reached_ns_) : t_ns;
  write(tf_, time_ns, TFMessage{{transform}});
  write(odometry_, time_ns, to_odometry(pose, twist, {fixed, rig}, t_ns));
}

/// Remembers the pose of this time. The clock never steps back.
void RigMotionPublisher::write_clock(std::int64_t t_ns) {
  constexpr std::size_t kRemembered = 1000;
  pose_times_ns_.push_back(t_ns);
  if (pose_times_ns_.size() > kRemembered) pose_times_ns_.pop_front();
  if (last_pose_ns_ && t_ns < *last_pose_ns_) return;
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
  static const ImuFormat kOwn;
  const ImuFormat& format = imu.format == nullptr ? kOwn : *imu.format;
  const glidar::Imu& errors = rig_.imus[index].imu;
  const Eigen::Matrix3d& axes = imu.published_from_imu;
  Imu message;
  message.header = {.stamp = time_from_ns(t_ns), .frame_id = imu.frame_id};
  const std::array<double, 4>& q = format.orientation_xyzw;
  message.orientation = {q[0], q[1], q[2], q[3]};
  message.orientation_covariance = format.orientation_covariance;
  if (has_imu_orientation_) {
    Pose world_from_published = imu.samples.ground_truth.world_from_imu[sample];
    world_from_published.linear() *= axes.transpose();
    const PoseVector pose = to_xyz_wxyz(world_from_published);
    message.orientation = {pose[4], pose[5], pose[6], pose[3]};
    message.orientation_covariance = same_variances(kExactVariance);
  }
  message.angular_velocity =
      vector_message(axes * imu.samples.angular_velocity_rad_s[sample] / format.rate_unit_rad_s);
  message.angular_velocity_covariance =
      same_variances(format.rate_variance.value_or(white_variance(errors.gyroscope, errors)));
  message.linear_acceleration = vector_message(axes * imu.samples.specific_force_m_s2[sample] /
                                               format.acceleration_unit_m_s2);
  message.linear_acceleration_covariance = same_variances(
      format.acceleration_variance.value_or(white_variance(errors.accelerometer, errors)));
  write(imu.topic, t_ns, message);
}

}  // namespace glidar::ros

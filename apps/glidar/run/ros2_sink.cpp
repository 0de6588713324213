// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/ros2_sink.hpp>

#include <cmath>

namespace glidar::app {
namespace {

/// What others publish when they give the poses or the time.
std::vector<std::string> omitted_topics(const Ros2Flags& flags) {
  if (flags.pose_topic.empty()) return {};
  if (follows_ros_clock(flags)) return {"/clock"};
  return {"/tf", "/odom", "/ground_truth/odom", "/clock"};
}

}  // namespace

Ros2Sink::Ros2Sink(const dds::Participant& participant, const Ros2Flags& ros2,
                   const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin,
                   double speed)
    : topics_(participant, {.ros_namespace = ros2.ros_namespace, .omitted = omitted_topics(ros2)}),
      publisher_(make_rig_publisher(topics_, flags, prepared, origin)),
      speed_(speed) {}

HitColumnMask Ros2Sink::hit_columns(std::size_t sensor_index) const {
  return publisher_->hit_columns(sensor_index);
}

void Ros2Sink::write(const MeasuredFrame& measured) {
  publisher_->publish(measured.sensor_index, measured.frame, *measured.beams);
  last_due_ = measured.due;
  last_stamp_ns_ = measured.frame.stamp_ns;
}

void Ros2Sink::serve() {
  topics_.report_other_publishers();
  if (!last_due_ || speed_ <= 0.0) return;
  const std::chrono::duration<double, std::nano> passed =
      std::chrono::steady_clock::now() - *last_due_;
  publisher_->advance(last_stamp_ns_ + std::llround(speed_ * passed.count()));
}

std::chrono::milliseconds Ros2Sink::serve_interval() const {
  constexpr std::chrono::milliseconds kPaced{2};  // IMUs have hundreds of samples per second
  return speed_ > 0.0 ? kPaced : kDefaultServeInterval;
}

void Ros2Sink::finish() {
  publisher_->finish();
  topics_.finish();
}

}  // namespace glidar::app

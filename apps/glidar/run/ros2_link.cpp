// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/ros2_link.hpp>

#include <apps/glidar/run/ros2_sink.hpp>

namespace glidar::app {

Ros2Link::Ros2Link(const Ros2Flags& flags, link::ErrorLog& errors)
    : flags_(flags), participant_({.id = {}, .interface_name = flags.interface_name}, errors) {}

std::unique_ptr<FrameSink> Ros2Link::make_sink(const RenderFlags& flags,
                                               const PreparedScene& prepared, PoseOrigin origin,
                                               double speed) const {
  return std::make_unique<Ros2Sink>(participant_, flags_, flags, prepared, origin, speed);
}

std::unique_ptr<PoseSource> Ros2Link::make_source(const Ros2Schedule& schedule, std::size_t queue,
                                                  const PreparedScene& prepared,
                                                  const StopRequest& stop) {
  if (follows_ros_clock(flags_)) {
    clock_ = std::make_unique<dds::ClockSubscriber>(participant_);
    return std::make_unique<ClockSource>(*clock_, schedule, prepared.sensors, stop);
  }
  const dds::PoseTopic topic = dds::parse_pose_topic(flags_.pose_topic, flags_.ros_namespace);
  poses_ = std::make_unique<dds::PoseSubscriber>(participant_, topic, queue);
  return std::make_unique<Ros2PoseSource>(*poses_, schedule, prepared, stop);
}

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/clock_subscriber.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/dds/topic_reader.hpp>

namespace glidar::dds {
namespace {

constexpr ros::Qos kClockQos = {.reliable = false, .depth = 1};  // of rclcpp::ClockQoS

}  // namespace

struct ClockSubscriber::Impl {
  explicit Impl(const Participant& its_participant)
      : participant(its_participant),
        reader(participant, ReaderOptions{"/clock", ros::message_type<ros::Clock>(), kClockQos},
               wake_up) {}

  const Participant& participant;
  WakeUp wake_up;
  TopicReader reader;
  PoseCounts counts;
};

ClockSubscriber::ClockSubscriber(const Participant& participant)
    : impl_(std::make_unique<Impl>(participant)) {}

ClockSubscriber::~ClockSubscriber() = default;

std::optional<std::int64_t> ClockSubscriber::receive() {
  impl_->wake_up.clear();
  std::optional<std::int64_t> newest;
  while (const std::optional<link::Payload> message = impl_->reader.take()) {
    ++impl_->counts.received;
    try {
      newest = decode_clock(message->bytes());
    } catch (const Error& error) {
      ++impl_->counts.invalid;
      impl_->participant.errors().report("time of ROS topic /clock", error.what());
    }
  }
  return newest;
}

int ClockSubscriber::descriptor() const {
  return impl_->wake_up.descriptor();
}

PoseCounts ClockSubscriber::counts() const {
  return impl_->counts;
}

}  // namespace glidar::dds

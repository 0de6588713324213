// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Instead of the files that include Cyclone DDS in builds without it.
#include <glidar/core/error.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/topics.hpp>

namespace glidar::dds {

bool has_dds() {
  return false;
}

LogSink::LogSink(link::ErrorLog& log) : log_(log) {}

LogSink::~LogSink() = default;

Participant::Participant(const DomainOptions& /*options*/, link::ErrorLog& errors)
    : errors_(errors), sink_(errors) {
  throw Error({.where = "ROS 2",
               .found = "this build does not contain it",
               .remedy = "install Cyclone DDS (Debian: cyclonedds-dev) and build again"});
}

Participant::~Participant() = default;

TopicWriter::TopicWriter(const Participant& participant, const std::string& full_name,
                         const ros::MessageType& /*type*/, const ros::Qos& /*qos*/)
    : errors_(participant.errors()), name_(full_name) {}

TopicWriter::~TopicWriter() = default;

bool TopicWriter::write(const link::Payload& /*message*/) {
  return false;
}

bool TopicWriter::has_readers() const {
  return false;
}

bool TopicWriter::wait_for_acknowledgements(std::chrono::milliseconds /*timeout*/) const {
  return true;
}

Publications::Publications(const Participant& /*participant*/, const WakeUp& /*wake_up*/) {}

Publications::~Publications() = default;

std::vector<Publication> Publications::of(const std::string& /*full_name*/) const {
  return {};
}

struct PoseSubscriber::Impl {};

PoseSubscriber::PoseSubscriber(const Participant& /*participant*/, const PoseTopic& /*topic*/,
                               std::size_t /*queue*/) {}

PoseSubscriber::~PoseSubscriber() = default;

std::optional<TimedPose> PoseSubscriber::receive() {
  return std::nullopt;
}

int PoseSubscriber::descriptor() const {
  return -1;
}

PoseCounts PoseSubscriber::counts() const {
  return {};
}

struct ClockSubscriber::Impl {};

ClockSubscriber::ClockSubscriber(const Participant& /*participant*/) {}

ClockSubscriber::~ClockSubscriber() = default;

std::optional<std::int64_t> ClockSubscriber::receive() {
  return std::nullopt;
}

int ClockSubscriber::descriptor() const {
  return -1;
}

PoseCounts ClockSubscriber::counts() const {
  return {};
}

}  // namespace glidar::dds

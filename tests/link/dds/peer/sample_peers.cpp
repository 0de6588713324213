// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sample_peers.hpp"

#include "../pose_messages.hpp"
#include "program.hpp"

#include <glidar/io/bags/bag.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/topics.hpp>

#include <io/ros/sample_messages.hpp>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <iostream>
#include <map>
#include <memory>

namespace glidar::testing {
namespace {

constexpr std::uint32_t kSamples = 3;

std::string topic_of(const ros::MessageType& type) {
  return "/" + std::string(type.ros1_name.substr(type.ros1_name.find('/') + 1));
}

void write_bag(const std::filesystem::path& path) {
  const auto bag = bags::create_bag(path);
  std::map<const ros::MessageType*, std::size_t> topics;
  for (const ros::MessageType& type : ros::message_types())
    topics[&type] = bag->add_topic({topic_of(type), &type, type.qos});
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    ros::for_all_messages(i, [&](const auto& message) {
      using Message = std::decay_t<decltype(message)>;
      ros::write_message(*bag, topics.at(&ros::message_type<Message>()), i, message);
    });
  }
  bag->finish();
}

}  // namespace

int write_samples(const std::filesystem::path& bag) {
  write_bag(bag);
  Program program;
  std::map<const ros::MessageType*, std::unique_ptr<dds::TopicWriter>> writers;
  for (const ros::MessageType& type : ros::message_types()) {
    writers[&type] =
        std::make_unique<dds::TopicWriter>(program.participant, topic_of(type), type, type.qos);
  }
  dds::TopicWriter fixed(program.participant, "/tf_static", ros::message_type<ros::TFMessage>(),
                         ros::kStaticTransformQos);
  fixed.write(payload_of(ros::sample<ros::TFMessage>(0)));
  print_line("ready");
  for (std::string line; std::getline(std::cin, line);) {
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      ros::for_all_messages(i, [&](const auto& message) {
        using Message = std::decay_t<decltype(message)>;
        dds::TopicWriter& writer = *writers.at(&ros::message_type<Message>());
        writer.write(payload_of(message));
        (void)writer.wait_for_acknowledgements(std::chrono::minutes(10));
      });
    }
    print_line("written");
  }
  return 0;
}

int print_poses(const std::string& topic) {
  Program program;
  dds::PoseSubscriber subscriber(program.participant, dds::parse_pose_topic(topic), 1000);
  for (;;) {
    while (const auto pose = subscriber.receive()) {
      const Eigen::Vector3d& p = pose->position_m;
      const Eigen::Quaterniond& q = pose->orientation;
      print_line(
          fmt::format(R"({{"t_ns": {}, "position": [{}, {}, {}], "quaternion": [{}, {}, {}, {}]}})",
                      pose->t_ns, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()));
    }
    std::array<pollfd, 2> entries = {
        pollfd{.fd = subscriber.descriptor(), .events = POLLIN, .revents = 0},
        pollfd{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0}};
    poll(entries.data(), entries.size(), -1);
    if (entries[1].revents != 0) return 0;
  }
}

}  // namespace glidar::testing

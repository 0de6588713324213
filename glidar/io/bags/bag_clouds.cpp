// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_clouds.hpp>

#include <glidar/io/bags/bag_topics.hpp>
#include <glidar/io/ros/cloud_from_message.hpp>

#include <array>
#include <utility>

namespace glidar::bags {
namespace {

template <class Message>
void convert(const BagMessage& from, ros::Wire wire, BagCloud& to) {
  const auto message = ros::deserialize<Message>(from.data, wire);
  to.stamp_ns = ros::to_ns(message.header.stamp);
  to.time_ns = from.time_ns;
  to.cloud = ros::to_point_cloud(message);
}

}  // namespace

BagClouds::BagClouds(std::unique_ptr<BagReader> bag, const std::filesystem::path& path,
                     const std::string& topic)
    : bag_(std::move(bag)) {
  const ros::MessageType* custom = &ros::message_type<ros::CustomMsg>();
  const std::array types = {&ros::message_type<ros::PointCloud2>(), custom};
  const std::size_t found = find_topic(*bag_, topic, types, path);
  topic_ = bag_->topics()[found];
  is_custom_ = type_of(topic_) == custom;
  bag_->select({&found, 1});
}

bool BagClouds::next(BagCloud& cloud) {
  BagMessage message;
  if (!bag_->next(message)) return false;
  if (is_custom_) {
    convert<ros::CustomMsg>(message, topic_.wire, cloud);
  } else {
    convert<ros::PointCloud2>(message, topic_.wire, cloud);
  }
  return true;
}

}  // namespace glidar::bags

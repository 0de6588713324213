// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Writes bags of all formats with samples of all messages into the folder given, and the table of
// types, for bag_readers_test.py.
#include <glidar/io/bags/bag.hpp>

#include <io/ros/sample_messages.hpp>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>

namespace glidar {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::uint32_t kMessages = 3;

/// /point_cloud2 of PointCloud2, and so on: the last part of the type's name.
std::string topic_name(const ros::MessageType& type) {
  return "/" + std::string(type.ros1_name.substr(type.ros1_name.find('/') + 1));
}

void write_bag(const std::filesystem::path& path, const bags::BagOptions& options) {
  const auto bag = bags::create_bag(path, options);
  std::map<const ros::MessageType*, std::size_t> topics;
  for (const ros::MessageType& type : ros::message_types())
    topics[&type] = bag->add_topic({topic_name(type), &type, type.qos});
  bag->add_topic({"/tf_static", &ros::message_type<ros::TFMessage>(), ros::kStaticTransformQos});
  for (std::uint32_t i = 0; i < kMessages; ++i) {
    ros::for_all_messages(i, [&](const auto& message) {
      using Message = std::decay_t<decltype(message)>;
      ros::write_message(*bag, topics.at(&ros::message_type<Message>()), kStart_ns + i, message);
    });
  }
  bag->finish();
}

void write_types(const std::filesystem::path& path) {
  nlohmann::json all;
  for (const ros::MessageType& type : ros::message_types()) {
    all.push_back({{"name", type.name},
                   {"ros1_name", type.ros1_name},
                   {"type_hash", type.type_hash},
                   {"ros2msg", ros::definition_text(type)}});
  }
  std::ofstream(path) << all.dump(1);
}

void write_all_bags(const std::filesystem::path& folder) {
  using bags::Compression;
  write_bag(folder / "none.mcap", {});
  write_bag(folder / "lz4.mcap", {.compression = Compression::lz4});
  write_bag(folder / "zstd.mcap", {.compression = Compression::zstd});
  write_bag(folder / "sqlite.rosbag2", {});
  write_bag(folder / "mcap.rosbag2", {.mcap_storage = true});
  bags::create_bag(folder / "empty.mcap")->finish();
  bags::create_bag(folder / "empty.rosbag2")->finish();
  write_types(folder / "types.json");
}

}  // namespace
}  // namespace glidar

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    glidar::write_all_bags(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/sqlite.hpp>

#include <optional>
#include <set>

namespace glidar::bags {

/// Version of metadata.yaml (ros2/rosbag2, rosbag2_storage/bag_metadata.hpp): the last one that
/// stores QoS as text, which all readers of versions 7 to 9 accept.
inline constexpr int kMetadataVersion = 8;
/// As rosbag2 spells a distribution that it does not know.
inline constexpr const char* kRosDistro = "unknown";

/// Writes the SQLite storage of rosbag2, with the tables of schema version 4, directly to `path`.
class SqliteBagWriter : public BagWriter {
 public:
  explicit SqliteBagWriter(const std::filesystem::path& path);

  [[nodiscard]] ros::Wire wire() const override { return ros::Wire::cdr; }
  std::size_t add_topic(const ros::Topic& topic) override;
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  void finish() override;
  /// The content of metadata.yaml, which the database stores too; before finish().
  void put_metadata(const std::string& yaml);

 private:
  Database database_;
  std::optional<Statement> insert_message_;
  std::size_t topics_ = 0;
  std::set<const ros::MessageType*> defined_;
};

}  // namespace glidar::bags

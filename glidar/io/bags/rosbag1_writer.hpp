// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/byte_writer.hpp>
#include <glidar/io/bags/written_topics.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <map>
#include <utility>

namespace glidar::bags {

/// Writes bags of ROS 1, version 2.0: wiki.ros.org/Bags/Format/2.0.
class Rosbag1Writer : public BagWriter {
 public:
  /// Throws Error for Zstandard.
  Rosbag1Writer(const std::filesystem::path& path, const BagOptions& options);

  [[nodiscard]] ros::Wire wire() const override { return ros::Wire::ros1; }
  std::size_t add_topic(const ros::Topic& topic) override;
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  void finish() override;

 private:
  /// Times and offsets of the messages of a connection in a chunk.
  using Index = std::vector<std::pair<std::int64_t, std::uint32_t>>;

  void write_chunk();
  void write_indexes(std::uint64_t position);
  void write_bag_header(std::uint64_t index_position);

  BagOptions options_;
  AtomicFile file_;
  WrittenTopics topics_;
  Bytes chunk_;
  std::map<std::uint32_t, Index> indexes_;  ///< of the chunk, by connection
  Bytes chunk_infos_;
  std::uint32_t chunks_ = 0;
  Bytes packed_;  ///< the compressed chunk
};

}  // namespace glidar::bags

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/byte_writer.hpp>
#include <glidar/io/bags/written_topics.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <map>
#include <string_view>

namespace glidar::bags {

/// Writes MCAP with the profile ros2: messages in chunks, indexes of messages and chunks,
/// statistics and checksums of everything.
class McapWriter : public BagWriter {
 public:
  McapWriter(const std::filesystem::path& path, const BagOptions& options);

  std::size_t add_topic(const ros::Topic& topic) override;
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  void finish() override;

 private:
  /// Times and offsets of the messages of a channel in a chunk.
  using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

  void put(std::span<const std::byte> bytes);
  void write_chunk();
  std::map<std::uint16_t, std::uint64_t> write_message_indexes();
  void write_summary();

  BagOptions options_;
  AtomicFile file_;
  WrittenTopics topics_;
  std::uint32_t crc_ = 0;  ///< of all bytes of the data section, then of the summary
  Bytes chunk_;
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t chunk_last_ns_ = 0;
  std::map<std::uint16_t, MessageIndex> indexes_;  ///< of the chunk, by channel
  std::vector<const ros::MessageType*> schemas_;   ///< number i + 1
  Bytes schema_records_;
  Bytes channel_records_;
  Bytes chunk_indexes_;
  std::uint32_t chunks_ = 0;
  Bytes packed_;  ///< the compressed chunk
};

}  // namespace glidar::bags

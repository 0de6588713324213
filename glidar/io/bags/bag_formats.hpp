// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/bag_storage.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>

// website/docs/spec/index.md).

namespace glidar::bags::mcap {

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Opcode and length of a record.
inline constexpr std::size_t kRecordHead = 9;
/// Of a footer's content.
inline constexpr std::size_t kFooterBytes = 20;
/// Of a message's content before its data.
inline constexpr std::size_t kMessageHead = 22;

}  // namespace glidar::bags::mcap

namespace glidar::bags {

/// Opens an MCAP file with or without chunks, indexes and summary; what it reads counts in the
/// budget. Throws Error when it is damaged or has no footer, because a program ended before it was
/// complete.
std::unique_ptr<BagReader> open_mcap(const std::filesystem::path& path, SharedBudget budget);

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

namespace glidar::bags {

/// Opens a bag of ROS 1, version 2.0, without compression or with LZ4; what it reads counts in the
/// budget. Throws Error when it is damaged, has no index because a program ended before it was
/// complete, or is compressed by bzip2.
std::unique_ptr<BagReader> open_rosbag1(const std::filesystem::path& path, SharedBudget budget);

/// Opens a folder with metadata.yaml of any version, whose storage is sqlite3 or mcap without
/// compression of files or messages. Several files are merged by time. Throws Error.
std::unique_ptr<BagReader> open_rosbag2(const std::filesystem::path& path);

/// Throws Error unless the folder has a metadata.yaml that can be read.
void require_metadata(const std::filesystem::path& path);

/// A folder NAME.rosbag2 with metadata.yaml of version 8 and NAME_0.db3 (ros2/rosbag2,
/// rosbag2_storage_sqlite3, schema version 4) or NAME_0.mcap. Throws Error as create_bag() does,
/// and for compression with SQLite.
std::unique_ptr<BagWriter> create_rosbag2(const std::filesystem::path& path,
                                          const BagOptions& options);

}  // namespace glidar::bags

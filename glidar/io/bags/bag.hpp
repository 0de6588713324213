// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/file_text.hpp>
#include <glidar/io/ros/codec.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glidar::bags {

/// The formats of bags, by the suffix of their path.
enum class BagFormat : std::uint8_t {
  mcap,     ///< NAME.mcap, one file: mcap.dev/spec
  rosbag2,  ///< NAME.rosbag2, a folder with metadata.yaml
  rosbag1,  ///< NAME.bag, one file of ROS 1: wiki.ros.org/Bags/Format/2.0; only read
};

/// True for paths that name a bag: .mcap, .rosbag2 and .bag, and existing folders with a
/// metadata.yaml.
bool is_bag_path(const std::filesystem::path& path);

/// True for names with the suffix .mcap, .rosbag2 or .bag.
bool is_bag_name(const std::filesystem::path& path);

/// Throws Error naming the suffixes.
BagFormat bag_format_for(const std::filesystem::path& path);

enum class Compression : std::uint8_t { none, lz4, zstd };

struct BagOptions {
  Compression compression = Compression::none;  ///< of chunks
  bool mcap_storage = false;                    ///< rosbag2: one MCAP file instead of SQLite
};

/// Writes a bag, which appears under its name when finish() returns. Without finish() nothing
/// remains, and an existing bag stays unchanged.
using BagWriter = ros::MessageSink;

/// A new bag, in the format of the path's suffix. Throws Error when the suffix is unknown or that
/// of ROS 1, an option does not fit the format, or nothing can be created in the folder.
std::unique_ptr<BagWriter> create_bag(const std::filesystem::path& path,
                                      const BagOptions& options = {});

/// A topic of a bag that is read.
struct StoredTopic {
  FileText name;
  FileText type;  ///< as the bag names it
  ros::Wire wire = ros::Wire::cdr;
  bool is_ros = true;  ///< false: messages of another encoding, such as JSON in MCAP
};

/// The data of a message that is still in the file of its bag.
class BagData {
 public:
  virtual ~BagData() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Copies the bytes from an offset on.
  virtual void copy(std::size_t offset, std::span<std::byte> to) = 0;
};

/// A message of a bag.
struct BagMessage {
  std::size_t topic = 0;  ///< index in topics()
  std::int64_t time_ns = 0;
  std::span<const std::byte> data;  ///< valid until the next call of next()
  BagData* in_file = nullptr;       ///< instead of `data`, see leave_in_file(); as long valid
};

/// Reads a bag in the order of its messages' times; holds only some chunks of it in memory.
class BagReader {
 public:
  BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  virtual ~BagReader() = default;

  [[nodiscard]] virtual std::span<const StoredTopic> topics() const = 0;
  /// Reads only these topics, by index; all before the first call.
  virtual void select(std::span<const std::size_t> topics) = 0;
  /// From now on, next() leaves data in the file if they can be copied from it piece by piece.
  virtual void leave_in_file() {}
  /// The next message; false at the end. Throws Error when the bag is damaged.
  virtual bool next(BagMessage& message) = 0;
};

/// Opens a bag. A folder of rosbag2 may have any name and several files, which must not be links to
/// files outside. The sandboxed process glidar-import reads it; it ends with the reader, or with
/// the thread that opened it. Throws Error when the bag is missing, damaged, incomplete, or
/// compressed in a way that is not supported, and when it exceeds the limits of an input of its
/// size.
std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path);

}  // namespace glidar::bags

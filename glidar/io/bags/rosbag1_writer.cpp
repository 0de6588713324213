// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/rosbag1_writer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/chunk_codec.hpp>
#include <glidar/io/bags/rosbag1_records.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace glidar::bags {
namespace {

using Rosbag1Op = rosbag1::Op;

constexpr std::int64_t kSecond = 1'000'000'000;

/// A field of a header: "NAME=value" behind its size.
void append_field(Bytes& to, std::string_view name, std::span<const std::byte> value) {
  append(to, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  append(to, name);
  append(to, "=");
  append(to, value);
}

void append_field(Bytes& to, std::string_view name, std::string_view value) {
  append_field(to, name, std::as_bytes(std::span(value)));
}

template <class Number>
requires std::is_integral_v<Number>
void append_field(Bytes& to, std::string_view name, Number value) {
  append_field(to, name, std::as_bytes(std::span(&value, 1)));
}

void append_op(Bytes& to, Rosbag1Op op) {
  append_field(to, "op", static_cast<std::uint8_t>(op));
}

/// A time: seconds and nanoseconds.
std::uint64_t packed_time(std::int64_t time_ns) {
  const auto seconds = static_cast<std::uint64_t>(time_ns / kSecond);
  const auto rest = static_cast<std::uint64_t>(time_ns % kSecond);
  return (rest << 32U) | seconds;
}

void append_connection(Bytes& to, std::uint32_t number, const WrittenTopic& topic) {
  Bytes header;
  append_op(header, Rosbag1Op::connection);
  append_field(header, "conn", number);
  append_field(header, "topic", topic.name);
  Bytes data;
  append_field(data, "topic", topic.name);
  append_field(data, "type", topic.type->ros1_name);
  append_field(data, "md5sum", topic.type->md5);
  append_field(data, "message_definition", ros::definition_text(*topic.type, ros::Wire::ros1));
  append_field(data, "callerid", "/glidar");
  append_field(data, "latching", topic.qos.transient_local ? "1" : "0");
  append_sized(to, header);
  append_sized(to, data);
}

}  // namespace

Rosbag1Writer::Rosbag1Writer(const std::filesystem::path& path, const BagOptions& options)
    : options_(options), file_(path), topics_(path.string()) {
  if (options_.compression == Compression::zstd) {
    throw Error(
        {path.string(), "Zstandard in a bag of ROS 1", "none or lz4", "use lz4, or write .mcap"});
  }
  file_.write(rosbag1::kMagic);
  write_bag_header(0);
}

std::size_t Rosbag1Writer::add_topic(const ros::Topic& topic) {
  return topics_.add(topic);
}

void Rosbag1Writer::write(std::size_t topic, std::int64_t time_ns,
                          std::span<const std::byte> message) {
  const WrittenTopic& written = topics_.count(topic, time_ns);
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::uint32_t>::max();
  if (time_ns / kSecond > kMaxSeconds) {
    throw Error({file_.path().string(), fmt::format("a message at {} ns", time_ns),
                 "times before the year 2106", "write .mcap"});
  }
  const auto connection = static_cast<std::uint32_t>(topic);
  if (written.messages == 1) append_connection(chunk_, connection, written);
  indexes_[connection].emplace_back(time_ns, static_cast<std::uint32_t>(chunk_.size()));
  Bytes header;
  append_op(header, Rosbag1Op::message);
  append_field(header, "conn", connection);
  append_field(header, "time", packed_time(time_ns));
  append_sized(chunk_, header);
  append_sized(chunk_, message);
  if (chunk_.size() >= kChunkBytes) write_chunk();
}

void Rosbag1Writer::write_chunk() {
  if (chunk_.empty()) return;
  if (chunk_.size() > std::numeric_limits<std::uint32_t>::max() / 2)
    throw Error({file_.path().string(), "a message of 2 GiB or more", "less", "write .mcap"});
  std::span<const std::byte> stored = chunk_;
  const bool is_packed = options_.compression == Compression::lz4;
  if (is_packed) {
    compress(chunk_, Compression::lz4, packed_);
    stored = packed_;
  }
  const std::uint64_t position = file_.position();
  Bytes header;
  append_op(header, Rosbag1Op::chunk);
  append_field(header, "compression", is_packed ? "lz4" : "none");
  append_field(header, "size", static_cast<std::uint32_t>(chunk_.size()));
  Bytes record;
  append_sized(record, header);
  append(record, static_cast<std::uint32_t>(stored.size()));
  file_.write(record);
  file_.write(stored);

  write_indexes(position);
  ++chunks_;
  chunk_.clear();
  indexes_.clear();
}

/// The index records of the chunk at `position`; its chunk info is written at the end of the bag.
void Rosbag1Writer::write_indexes(std::uint64_t position) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = 0;
  Bytes counts;
  for (const auto& [connection, index] : indexes_) {
    Bytes header;
    append_op(header, Rosbag1Op::index);
    append_field(header, "ver", std::uint32_t{1});
    append_field(header, "conn", connection);
    append_field(header, "count", static_cast<std::uint32_t>(index.size()));
    Bytes entries;
    for (const auto& [time_ns, offset] : index) {
      append(entries, packed_time(time_ns));
      append(entries, offset);
      first_ns = std::min(first_ns, time_ns);
      last_ns = std::max(last_ns, time_ns);
    }
    Bytes record;
    append_sized(record, header);
    append_sized(record, entries);
    file_.write(record);
    append(counts, connection);
    append(counts, static_cast<std::uint32_t>(index.size()));
  }
  Bytes header;
  append_op(header, Rosbag1Op::chunk_info);
  append_field(header, "ver", std::uint32_t{1});
  append_field(header, "chunk_pos", position);
  append_field(header, "start_time", packed_time(first_ns));
  append_field(header, "end_time", packed_time(last_ns));
  append_field(header, "count", static_cast<std::uint32_t>(indexes_.size()));
  append_sized(chunk_infos_, header);
  append_sized(chunk_infos_, counts);
}

void Rosbag1Writer::write_bag_header(std::uint64_t index_position) {
  Bytes header;
  append_op(header, Rosbag1Op::bag_header);
  append_field(header, "index_pos", index_position);
  append_field(header, "conn_count", static_cast<std::uint32_t>(topics_.all().size()));
  append_field(header, "chunk_count", chunks_);
  Bytes record;
  append_sized(record, header);
  constexpr std::size_t kSizeField = sizeof(std::uint32_t);
  const std::size_t padding = rosbag1::kBagHeaderBytes - record.size() - kSizeField;
  append_sized(record, std::string(padding, ' '));
  file_.write(record);
}

void Rosbag1Writer::finish() {
  write_chunk();
  const std::uint64_t index_position = file_.position();
  Bytes connections;
  for (std::size_t i = 0; i < topics_.all().size(); ++i)
    append_connection(connections, static_cast<std::uint32_t>(i), topics_.all()[i]);
  file_.write(connections);
  file_.write(chunk_infos_);
  file_.seek(rosbag1::kMagic.size());
  write_bag_header(index_position);
  file_.commit();
}

}  // namespace glidar::bags

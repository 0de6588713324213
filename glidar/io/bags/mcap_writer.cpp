// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/mcap_writer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/chunk_codec.hpp>
#include <glidar/io/bags/mcap_records.hpp>

#include <algorithm>
#include <utility>

namespace glidar::bags {
namespace {

using McapOp = mcap::Op;

/// Begins a record; its length is set by end_record().
std::size_t begin_record(Bytes& to, McapOp op) {
  append(to, static_cast<std::uint8_t>(op));
  append(to, std::uint64_t{0});
  return to.size();
}

void end_record(Bytes& to, std::size_t begin) {
  replace(to, begin - sizeof(std::uint64_t), std::uint64_t{to.size() - begin});
}

std::string_view mcap_name(Compression compression) {
  if (compression == Compression::lz4) return "lz4";
  return compression == Compression::zstd ? "zstd" : "";
}

void append_pair(Bytes& to, std::string_view key, std::string_view value) {
  append_sized(to, key);
  append_sized(to, value);
}

void append_schema(Bytes& to, std::uint16_t number, const ros::MessageType& type) {
  const std::size_t begin = begin_record(to, McapOp::schema);
  append(to, number);
  append_sized(to, type.name);
  append_sized(to, "ros2msg");
  append_sized(to, ros::definition_text(type));
  end_record(to, begin);
}

void append_channel(Bytes& to, std::uint16_t number, std::uint16_t schema,
                    const ros::Topic& topic) {
  Bytes metadata;
  append_pair(metadata, "offered_qos_profiles", ros::qos_yaml(topic.qos));
  append_pair(metadata, "topic_type_hash", topic.type->type_hash);
  const std::size_t begin = begin_record(to, McapOp::channel);
  append(to, number);
  append(to, schema);
  append_sized(to, topic.name);
  append_sized(to, "cdr");
  append_sized(to, metadata);
  end_record(to, begin);
}

/// Number of the schema; appends it to the vector if it is new.
std::uint16_t schema_number(std::vector<const ros::MessageType*>& schemas,
                            const ros::MessageType* type, bool& is_new) {
  const auto known = std::find(schemas.begin(), schemas.end(), type);
  is_new = known == schemas.end();
  const auto number = static_cast<std::uint16_t>(known - schemas.begin() + 1);
  if (is_new) schemas.push_back(type);
  return number;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, const BagOptions& options)
    : options_(options), file_(path), topics_(path.string()) {
  Bytes start;
  append(start, mcap::kMagic);
  const std::size_t begin = begin_record(start, McapOp::header);
  append_sized(start, "ros2");
  append_sized(start, "glidar");  // the program that writes
  end_record(start, begin);
  put(start);
  chunk_.reserve(kChunkBytes + kChunkBytes / 4);
}

std::size_t McapWriter::add_topic(const ros::Topic& topic) {
  const std::size_t index = topics_.add(topic);
  bool is_new = false;
  const std::uint16_t schema = schema_number(schemas_, topic.type, is_new);
  if (is_new) {
    const std::size_t begin = schema_records_.size();
    append_schema(schema_records_, schema, *topic.type);
    append(chunk_, std::span(schema_records_).subspan(begin));
  }
  const std::size_t begin = channel_records_.size();
  append_channel(channel_records_, static_cast<std::uint16_t>(index + 1), schema, topic);
  append(chunk_, std::span(channel_records_).subspan(begin));
  return index;
}

void McapWriter::write(std::size_t topic, std::int64_t time_ns,
                       std::span<const std::byte> message) {
  const WrittenTopic& written = topics_.count(topic, time_ns);
  const auto time = static_cast<std::uint64_t>(time_ns);
  const auto channel = static_cast<std::uint16_t>(topic + 1);
  chunk_first_ns_ = indexes_.empty() ? time : std::min(chunk_first_ns_, time);
  chunk_last_ns_ = indexes_.empty() ? time : std::max(chunk_last_ns_, time);
  indexes_[channel].emplace_back(time, chunk_.size());
  append(chunk_, static_cast<std::uint8_t>(McapOp::message));
  append(chunk_, std::uint64_t{mcap::kMessageHead + message.size()});
  append(chunk_, channel);
  append(chunk_, static_cast<std::uint32_t>(written.messages - 1));
  append(chunk_, time);
  append(chunk_, time);
  append(chunk_, message);
  if (chunk_.size() >= kChunkBytes) write_chunk();
}

void McapWriter::put(std::span<const std::byte> bytes) {
  file_.write(bytes);
  crc_ = crc32_of(bytes, crc_);
}

void McapWriter::write_chunk() {
  if (chunk_.empty()) return;
  const std::uint32_t chunk_crc = crc32_of(chunk_);
  std::span<const std::byte> stored = chunk_;
  if (options_.compression != Compression::none) {
    compress(chunk_, options_.compression, packed_);
    stored = packed_;
  }
  const std::string_view compression = mcap_name(options_.compression);
  const std::uint64_t chunk_offset = file_.position();
  Bytes head;
  const std::size_t begin = begin_record(head, McapOp::chunk);
  append(head, chunk_first_ns_);
  append(head, chunk_last_ns_);
  append(head, std::uint64_t{chunk_.size()});
  append(head, chunk_crc);
  append_sized(head, compression);
  append(head, std::uint64_t{stored.size()});
  replace(head, begin - sizeof(std::uint64_t), std::uint64_t{head.size() - begin + stored.size()});
  put(head);
  file_.write(stored);
  // What is stored as it is has the CRC that is known already.
  const bool is_known = options_.compression == Compression::none;
  crc_ = combined_crc32(crc_, is_known ? chunk_crc : crc32_of(stored), stored.size());
  const std::uint64_t indexes_offset = file_.position();
  Bytes offsets;
  for (const auto& [channel, offset] : write_message_indexes()) {
    append(offsets, channel);
    append(offsets, offset);
  }
  const std::size_t index = begin_record(chunk_indexes_, McapOp::chunk_index);
  append(chunk_indexes_, chunk_first_ns_);
  append(chunk_indexes_, chunk_last_ns_);
  append(chunk_indexes_, chunk_offset);
  append(chunk_indexes_, indexes_offset - chunk_offset);
  append_sized(chunk_indexes_, offsets);
  append(chunk_indexes_, file_.position() - indexes_offset);
  append_sized(chunk_indexes_, compression);
  append(chunk_indexes_, std::uint64_t{stored.size()});
  append(chunk_indexes_, std::uint64_t{chunk_.size()});
  end_record(chunk_indexes_, index);
  ++chunks_;
  chunk_.clear();
  indexes_.clear();
  chunk_first_ns_ = chunk_last_ns_ = 0;
}

std::map<std::uint16_t, std::uint64_t> McapWriter::write_message_indexes() {
  std::map<std::uint16_t, std::uint64_t> offsets;
  Bytes record;
  for (const auto& [channel, index] : indexes_) {
    offsets[channel] = file_.position();
    record.clear();
    const std::size_t begin = begin_record(record, McapOp::message_index);
    append(record, channel);
    append(record, static_cast<std::uint32_t>(2 * sizeof(std::uint64_t) * index.size()));
    for (const auto& [time, offset] : index) {
      append(record, time);
      append(record, offset);
    }
    end_record(record, begin);
    put(record);
  }
  return offsets;
}

void McapWriter::finish() {
  write_chunk();
  Bytes end;
  const std::size_t begin = begin_record(end, McapOp::data_end);
  append(end, crc_);
  end_record(end, begin);
  put(end);
  write_summary();
  file_.commit();
}

void McapWriter::write_summary() {
  Bytes statistics;
  std::size_t begin = begin_record(statistics, McapOp::statistics);
  append(statistics, topics_.messages());
  append(statistics, static_cast<std::uint16_t>(schemas_.size()));
  append(statistics, static_cast<std::uint32_t>(topics_.all().size()));
  append(statistics, std::uint32_t{0});  // attachments
  append(statistics, std::uint32_t{0});  // metadata
  append(statistics, chunks_);
  append(statistics, topics_.first_ns());
  append(statistics, topics_.last_ns());
  Bytes counts;
  for (std::size_t i = 0; i < topics_.all().size(); ++i) {
    append(counts, static_cast<std::uint16_t>(i + 1));
    append(counts, topics_.all()[i].messages);
  }
  append_sized(statistics, counts);
  end_record(statistics, begin);

  crc_ = 0;
  const std::uint64_t summary = file_.position();
  const std::pair<McapOp, const Bytes*> groups[] = {{McapOp::schema, &schema_records_},
                                                    {McapOp::channel, &channel_records_},
                                                    {McapOp::statistics, &statistics},
                                                    {McapOp::chunk_index, &chunk_indexes_}};
  Bytes offsets;
  for (const auto& [op, records] : groups) {
    if (records->empty()) continue;
    begin = begin_record(offsets, McapOp::summary_offset);
    append(offsets, static_cast<std::uint8_t>(op));
    append(offsets, file_.position());
    append(offsets, std::uint64_t{records->size()});
    end_record(offsets, begin);
    put(*records);
  }
  const std::uint64_t offsets_at = file_.position();
  Bytes footer;
  append(footer, static_cast<std::uint8_t>(McapOp::footer));
  append(footer, std::uint64_t{mcap::kFooterBytes});
  append(footer, summary);
  append(footer, offsets_at);
  put(offsets);
  put(footer);
  Bytes end;
  append(end, crc_);
  append(end, mcap::kMagic);
  file_.write(end);
}

}  // namespace glidar::bags

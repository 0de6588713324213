// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_formats.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/bag_storage.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glidar::bags {
namespace {

/// The head of a record.
struct McapRecord {
  mcap::Op op{};
  std::uint64_t size = 0;  ///< of its content
};

/// The schemas and channels of a file, each known after its record.
class McapChannels {
 public:
  /// Takes the content of a schema or channel record; ignores others and repetitions. Names and
  /// topics count in the budget.
  void add(mcap::Op op, ByteReader& content, InputBudget& budget);

  [[nodiscard]] const std::vector<StoredTopic>& topics() const { return topics_; }
  /// Index in topics(). Throws Error, at the reader's place, for an unknown channel.
  [[nodiscard]] std::size_t topic_of(std::uint16_t channel, const ByteReader& reader) const;

 private:
  void add_channel(ByteReader& content, InputBudget& budget);

  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::size_t> channels_;
  std::vector<StoredTopic> topics_;
};

McapRecord read_mcap_head(ByteReader& reader) {
  const auto op = static_cast<mcap::Op>(reader.number<std::uint8_t>());
  return {op, reader.number<std::uint64_t>()};
}

void McapChannels::add(mcap::Op op, ByteReader& content, InputBudget& budget) {
  if (op == mcap::Op::channel) return add_channel(content, budget);
  if (op != mcap::Op::schema) return;
  const auto number = content.number<std::uint16_t>();
  if (!schemas_.contains(number)) schemas_.emplace(number, content.name(budget));
}

void McapChannels::add_channel(ByteReader& content, InputBudget& budget) {
  const auto number = content.number<std::uint16_t>();
  const auto schema = content.number<std::uint16_t>();
  if (channels_.contains(number)) return;
  budget.take(Budget::topics, 1, content.place());
  StoredTopic topic;
  topic.name = content.name(budget);
  const std::string encoding = content.name(budget);
  const auto type = schemas_.find(schema);
  if (type != schemas_.end()) {
    budget.take_name(type->second.size(), content.place());
    topic.type = type->second;
  }
  topic.wire = encoding == "ros1" ? ros::Wire::ros1 : ros::Wire::cdr;
  topic.is_ros = encoding == "ros1" || encoding == "cdr";
  channels_.emplace(number, topics_.size());
  topics_.push_back(std::move(topic));
}

std::size_t McapChannels::topic_of(std::uint16_t channel, const ByteReader& reader) const {
  const auto known = channels_.find(channel);
  if (known == channels_.end())
    reader.reject(fmt::format("a message of channel {}, which is not described", channel));
  return known->second;
}

/// Of records that are neither chunks nor messages.
constexpr std::uint64_t kMaxRecord = std::uint64_t{16} << 20U;

/// Messages in a chunk, or in records that follow each other in the file.
struct McapChunk {
  StoredChunk stored;
  std::uint32_t crc = 0;  ///< 0: none
  ChunkRange range;
};

/// A time of MCAP. Throws Error beyond the year 2262.
std::int64_t time_of(std::uint64_t time, const ByteReader& reader) {
  if (time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    reader.reject(fmt::format("a time of {} ns", time));
  return static_cast<std::int64_t>(time);
}

Compression compression_of(const std::string& name, const std::string& place) {
  if (name.empty()) return Compression::none;
  if (name == "lz4") return Compression::lz4;
  if (name == "zstd") return Compression::zstd;
  throw Error({place, "a chunk compressed by '" + excerpt(name) + "'", "none, lz4 or zstd",
               "write the bag again with one of them"});
}

/// Walks through the records of a file without reading messages.
class McapScan {
 public:
  McapScan(BagFile& file, InputBudget& budget) : file_(file), budget_(budget) {}

  void run();
  std::vector<McapChunk> chunks;
  McapChannels channels;

 private:
  void check_ends();
  void take_record(const McapRecord& record, std::uint64_t at);
  void add_chunk(std::uint64_t at, std::uint64_t size);
  void add_message(std::uint64_t at, std::uint64_t size);

  BagFile& file_;
  InputBudget& budget_;
  bool ended_ = false;
  std::optional<std::uint64_t> run_end_;  ///< end of the last chunk of plain messages
};

void McapScan::run() {
  check_ends();
  std::uint64_t at = mcap::kMagic.size();
  const std::uint64_t end = file_.size() - mcap::kMagic.size();
  while (at < end && !ended_) {
    if (end - at < mcap::kRecordHead) reject_bag(file_.place(at), "a record that ends early");
    ByteReader head(file_.peek(at, mcap::kRecordHead), file_.place(at));
    const McapRecord record = read_mcap_head(head);
    at += mcap::kRecordHead;
    if (record.size > end - at) reject_bag(file_.place(at), "a record longer than the file");
    take_record(record, at);
    at += record.size;
  }
  if (!ended_) reject_bag(file_.place(at), "no footer");
}

void McapScan::check_ends() {
  const std::size_t size = mcap::kMagic.size();
  const auto is_magic = [&](std::uint64_t at) {
    const auto bytes = file_.peek(at, size);
    return std::equal(bytes.begin(), bytes.end(), std::as_bytes(std::span(mcap::kMagic)).begin());
  };
  if (file_.size() < 2 * size || !is_magic(0))
    reject_bag(file_.place(0), "no MCAP file", "a file that begins with \\x89MCAP0\\r\\n");
  if (is_magic(file_.size() - size)) return;
  throw Error({file_.place(file_.size() - size), "the file has no end", "a file that was completed",
               "use `mcap recover` or record it again"});
}

void McapScan::take_record(const McapRecord& record, std::uint64_t at) {
  switch (record.op) {
    case mcap::Op::footer:
      ended_ = true;
      return;
    case mcap::Op::chunk:
      return add_chunk(at, record.size);
    case mcap::Op::message:
      return add_message(at, record.size);
    case mcap::Op::schema:
    case mcap::Op::channel: {
      if (record.size > kMaxRecord)
        reject_bag(file_.place(at), "a schema or channel of more than 16 MiB");
      ByteReader content(file_.peek(at, record.size), file_.place(at));
      return channels.add(record.op, content, budget_);
    }
    default:
      return;
  }
}

void McapScan::add_chunk(std::uint64_t at, std::uint64_t size) {
  constexpr std::uint64_t kMaxHead = 64;
  const std::uint64_t head_size = std::min(size, kMaxHead);
  ByteReader head(file_.peek(at, head_size), file_.place(at));
  McapChunk chunk;
  chunk.range.first_ns = time_of(head.number<std::uint64_t>(), head);
  chunk.range.last_ns = time_of(head.number<std::uint64_t>(), head);
  chunk.stored.size = head.number<std::uint64_t>();
  chunk.crc = head.number<std::uint32_t>();
  chunk.stored.compression = compression_of(head.text(), head.place());
  chunk.stored.stored_size = head.number<std::uint64_t>();
  chunk.stored.offset = at + head.position();
  if (chunk.stored.stored_size > size - head.position())
    head.reject("a chunk longer than its record");
  chunks.push_back(chunk);
  run_end_.reset();
}

/// Messages outside chunks are read in runs of up to kChunkBytes.
void McapScan::add_message(std::uint64_t at, std::uint64_t size) {
  if (size < mcap::kMessageHead) reject_bag(file_.place(at), "a message that ends early");
  ByteReader head(file_.peek(at, mcap::kMessageHead), file_.place(at));
  head.take(sizeof(std::uint16_t) + sizeof(std::uint32_t));
  const std::int64_t time_ns = time_of(head.number<std::uint64_t>(), head);
  const std::uint64_t begin = at - mcap::kRecordHead;
  const std::uint64_t whole = size + mcap::kRecordHead;
  if (run_end_ == begin && chunks.back().stored.size < kChunkBytes) {
    McapChunk& run = chunks.back();
    run.stored.size = run.stored.stored_size += whole;
    run.range.first_ns = std::min(run.range.first_ns, time_ns);
    run.range.last_ns = std::max(run.range.last_ns, time_ns);
  } else {
    chunks.push_back({.stored = {.offset = begin, .stored_size = whole, .size = whole},
                      .range = {time_ns, time_ns}});
  }
  run_end_ = begin + whole;
}

class McapReader : public BagReader {
 public:
  McapReader(const std::filesystem::path& path, SharedBudget budget)
      : file_(path), budget_(std::move(budget)) {
    McapScan scan(file_, *budget_);
    scan.run();
    chunks_ = std::move(scan.chunks);
    channels_ = std::move(scan.channels);
    if (channels_.topics().empty()) find_channels();
    std::vector<ChunkRange> ranges;
    for (const McapChunk& chunk : chunks_) ranges.push_back(chunk.range);
    merger_.emplace(path.string(), std::move(ranges), budget_,
                    [this](std::size_t number, Bytes reused) {
                      return load(chunks_[number], std::move(reused));
                    });
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return channels_.topics(); }

  void select(std::span<const std::size_t> topics) override {
    std::vector<bool> selected(channels_.topics().size(), false);
    for (const std::size_t topic : topics) selected.at(topic) = true;
    merger_->select(std::move(selected));
  }

  bool next(BagMessage& message) override { return merger_->next(message); }

 private:
  Bytes records_of(const McapChunk& chunk, Bytes reused = {}) {
    Bytes records = read_chunk(file_, chunk.stored, *budget_, std::move(reused));
    if (chunk.crc != 0 && crc32_of(records) != chunk.crc)
      reject_bag(file_.place(chunk.stored.offset), "a chunk whose checksum does not match");
    return records;
  }

  LoadedChunk load(const McapChunk& chunk, Bytes reused) {
    LoadedChunk loaded;
    loaded.bytes = records_of(chunk, std::move(reused));
    ByteReader reader(loaded.bytes, "chunk at " + file_.place(chunk.stored.offset));
    while (reader.left() > 0) {
      const McapRecord record = read_mcap_head(reader);
      const std::size_t begin = reader.position();
      ByteReader content(reader.take(record.size), reader.place());
      if (record.op != mcap::Op::message) continue;
      const auto channel = content.number<std::uint16_t>();
      content.number<std::uint32_t>();  // the number in the sequence
      const std::int64_t time_ns = time_of(content.number<std::uint64_t>(), content);
      content.number<std::uint64_t>();  // the time of publication
      loaded.entries.push_back({time_ns, channels_.topic_of(channel, reader),
                                begin + content.position(), content.left()});
    }
    return loaded;
  }

  /// In a file without a summary, channels are described in chunks only.
  void find_channels() {
    for (const McapChunk& chunk : chunks_) {
      const Bytes records = records_of(chunk);
      ByteReader reader(records, "chunk at " + file_.place(chunk.stored.offset));
      while (reader.left() > 0) {
        const McapRecord record = read_mcap_head(reader);
        ByteReader content(reader.take(record.size), reader.place());
        channels_.add(record.op, content, *budget_);
      }
    }
  }

  BagFile file_;
  SharedBudget budget_;
  std::vector<McapChunk> chunks_;
  McapChannels channels_;
  std::optional<ChunkMerger> merger_;
};

}  // namespace

std::unique_ptr<BagReader> open_mcap(const std::filesystem::path& path, SharedBudget budget) {
  return std::make_unique<McapReader>(path, std::move(budget));
}

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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_formats.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/bag_storage.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace glidar::bags {
namespace {

// wiki.ros.org/Bags/Format/2.0

constexpr std::string_view kRosbag1Magic = "#ROSBAG V2.0\n";

enum class Rosbag1Op : std::uint8_t {
  message = 0x02,
  bag_header = 0x03,
  chunk = 0x05,
  chunk_info = 0x06,
  connection = 0x07,
};

/// Of headers, and of the data of records other than chunks.
constexpr std::uint32_t kMaxHeader = std::uint32_t{16} << 20U;

/// The fields of a header, which refer to its bytes.
class BagFields {
 public:
  explicit BagFields(std::span<const std::byte> bytes, std::string place)
      : place_(std::move(place)) {
    ByteReader reader(bytes, place_);
    while (reader.left() > 0) {
      const std::span<const std::byte> field = reader.sized();
      const auto equals = std::find(field.begin(), field.end(), std::byte{'='});
      if (equals == field.end()) reader.reject("a field without '='");
      const auto name_size = static_cast<std::size_t>(equals - field.begin());
      const std::string_view name(reinterpret_cast<const char*>(field.data()), name_size);
      if (fields_.size() == 100) reader.reject("a header of more than 100 fields");
      fields_.insert_or_assign(name, field.subspan(name_size + 1));
    }
  }

  template <class Number>
  [[nodiscard]] Number number(const std::string& name) const {
    const std::span<const std::byte> bytes = value(name);
    if (bytes.size() != sizeof(Number))
      reject_bag(place_, "a field '" + name + "' of another size");
    Number number;
    std::memcpy(&number, bytes.data(), sizeof number);
    return number;
  }

  [[nodiscard]] std::int64_t time_ns(const std::string& name) const {
    const auto packed = number<std::uint64_t>(name);
    return static_cast<std::int64_t>((packed & 0xFFFFFFFFU) * 1'000'000'000U + (packed >> 32U));
  }

  [[nodiscard]] std::string name(const std::string& key, InputBudget& budget) const {
    const std::span<const std::byte> bytes = value(key);
    budget.take_name(bytes.size(), place_);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[nodiscard]] Rosbag1Op op() const { return static_cast<Rosbag1Op>(number<std::uint8_t>("op")); }

 private:
  [[nodiscard]] std::span<const std::byte> value(const std::string& name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) reject_bag(place_, "no field '" + name + "'");
    return found->second;
  }

  std::string place_;
  std::map<std::string_view, std::span<const std::byte>> fields_;
};

struct Rosbag1Chunk {
  std::uint64_t position = 0;  ///< of the record
  StoredChunk stored;
  std::optional<ChunkRange> range;  ///< from its chunk info
};

Compression rosbag1_compression(const std::string& name, const std::string& place) {
  if (name == "none") return Compression::none;
  if (name == "lz4") return Compression::lz4;
  throw Error({place, "a chunk compressed by '" + excerpt(name) + "'", "none or lz4",
               "use `rosbag decompress`"});
}

class Rosbag1Reader : public BagReader {
 public:
  Rosbag1Reader(const std::filesystem::path& path, SharedBudget budget)
      : file_(path), budget_(std::move(budget)) {
    const auto magic = std::as_bytes(std::span(kRosbag1Magic));
    const auto start = file_.peek(0, std::min<std::uint64_t>(magic.size(), file_.size()));
    if (!std::ranges::equal(start, magic))
      reject_bag(file_.place(0), "no bag of ROS 1", "a file that begins with #ROSBAG V2.0");
    std::uint64_t at = kRosbag1Magic.size();
    while (at < file_.size()) at = scan_record(at);
    std::vector<ChunkRange> ranges;
    for (const Rosbag1Chunk& chunk : chunks_) {
      if (!chunk.range) reject_bag(file_.place(chunk.position), "a chunk that the index lacks");
      ranges.push_back(*chunk.range);
    }
    merger_.emplace(path.string(), std::move(ranges), budget_,
                    [this](std::size_t number, Bytes reused) {
                      return load(chunks_[number], std::move(reused));
                    });
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return topics_; }

  void select(std::span<const std::size_t> topics) override {
    std::vector<bool> selected(topics_.size(), false);
    for (const std::size_t topic : topics) selected.at(topic) = true;
    merger_->select(std::move(selected));
  }

  bool next(BagMessage& message) override { return merger_->next(message); }

 private:
  std::uint32_t size_at(std::uint64_t at) {
    return ByteReader(file_.peek(at, sizeof(std::uint32_t)), file_.place(at))
        .number<std::uint32_t>();
  }

  /// Returns the place of the next record.
  std::uint64_t scan_record(std::uint64_t at) {
    const std::uint32_t header_size = size_at(at);
    if (header_size > kMaxHeader) reject_bag(file_.place(at), "a header of more than 16 MiB");
    const std::uint64_t header_at = at + sizeof header_size;
    const Bytes header = file_.read(header_at, header_size);
    const BagFields fields(header, file_.place(at));
    const std::uint64_t data_at = header_at + header_size + sizeof(std::uint32_t);
    const std::uint32_t data_size = size_at(data_at - sizeof(std::uint32_t));
    if (data_size > file_.size() - data_at)
      reject_bag(file_.place(at), "a record longer than the file");
    switch (fields.op()) {
      case Rosbag1Op::bag_header:
        if (fields.number<std::uint64_t>("index_pos") == 0)
          throw Error({file_.place(at), "the bag has no index", "a bag that was completed",
                       "use `rosbag reindex`"});
        break;
      case Rosbag1Op::chunk:
        by_position_[at] = chunks_.size();
        chunks_.push_back(
            {at,
             {data_at, data_size, fields.number<std::uint32_t>("size"),
              rosbag1_compression(fields.name("compression", *budget_), file_.place(at))},
             std::nullopt});
        break;
      case Rosbag1Op::connection:
        add_connection(fields, data_at, data_size);
        break;
      case Rosbag1Op::chunk_info:
        add_chunk_info(fields, at);
        break;
      default:
        break;
    }
    return data_at + data_size;
  }

  void add_connection(const BagFields& fields, std::uint64_t data_at, std::uint32_t data_size) {
    const auto number = fields.number<std::uint32_t>("conn");
    if (connections_.contains(number)) return;
    if (data_size > kMaxHeader)
      reject_bag(file_.place(data_at), "a connection of more than 16 MiB");
    const Bytes data = file_.read(data_at, data_size);
    const BagFields details(data, file_.place(data_at));
    budget_->take(Budget::topics, 1, file_.place(data_at));
    connections_.emplace(number, topics_.size());
    topics_.push_back(
        {fields.name("topic", *budget_), details.name("type", *budget_), ros::Wire::ros1, true});
  }

  void add_chunk_info(const BagFields& fields, std::uint64_t at) {
    const auto chunk = by_position_.find(fields.number<std::uint64_t>("chunk_pos"));
    if (chunk == by_position_.end()) reject_bag(file_.place(at), "the index of a missing chunk");
    chunks_[chunk->second].range = {fields.time_ns("start_time"), fields.time_ns("end_time")};
  }

  LoadedChunk load(const Rosbag1Chunk& chunk, Bytes reused) {
    LoadedChunk loaded;
    loaded.bytes = read_chunk(file_, chunk.stored, *budget_, std::move(reused));
    ByteReader reader(loaded.bytes, "chunk at " + file_.place(chunk.stored.offset));
    while (reader.left() > 0) {
      const BagFields fields(reader.sized(), reader.place());
      const std::size_t size = reader.number<std::uint32_t>();
      const std::size_t begin = reader.position();
      reader.take(size);
      if (fields.op() != Rosbag1Op::message) continue;
      const auto connection = connections_.find(fields.number<std::uint32_t>("conn"));
      if (connection == connections_.end()) reader.reject("a message of an unknown connection");
      loaded.entries.push_back({fields.time_ns("time"), connection->second, begin, size});
    }
    return loaded;
  }

  BagFile file_;
  SharedBudget budget_;
  std::vector<StoredTopic> topics_;
  std::map<std::uint32_t, std::size_t> connections_;  ///< index in topics_
  std::vector<Rosbag1Chunk> chunks_;
  std::map<std::uint64_t, std::size_t> by_position_;  ///< index in chunks_
  std::optional<ChunkMerger> merger_;
};

}  // namespace

std::unique_ptr<BagReader> open_rosbag1(const std::filesystem::path& path, SharedBudget budget) {
  return std::make_unique<Rosbag1Reader>(path, std::move(budget));
}

}  // namespace glidar::bags

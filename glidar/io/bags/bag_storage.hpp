// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/files/input_file.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace glidar::bags {

/// Throws the Error of a damaged bag. `place` is its path, with a byte offset or the like.
[[noreturn]] void reject_bag(const std::string& place, const std::string& found,
                             const std::string& allowed = "a complete bag");

/// Reads numbers and texts from bytes, of which no size is trusted.
class ByteReader {
 public:
  /// `place` appears in errors.
  ByteReader(std::span<const std::byte> bytes, std::string place)
      : bytes_(bytes), place_(std::move(place)) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  std::span<const std::byte> take(std::uint64_t size) {
    if (size > left()) reject("a record that ends early");
    const std::span<const std::byte> taken = bytes_.subspan(position_, size);
    position_ += size;
    return taken;
  }

  template <class Number>
  requires std::is_integral_v<Number> Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  /// A count of bytes as u32, and the bytes.
  std::span<const std::byte> sized() { return take(number<std::uint32_t>()); }

  std::string text() {
    const std::span<const std::byte> bytes = sized();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// A text that is a name, which counts in the budget before it is copied.
  std::string name(InputBudget& budget) {
    const std::span<const std::byte> bytes = sized();
    budget.take_name(bytes.size(), place_);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[noreturn]] void reject(const std::string& found) const { reject_bag(place_, found); }

 private:
  std::span<const std::byte> bytes_;
  std::string place_;
  std::size_t position_ = 0;
};

static_assert(std::endian::native == std::endian::little, "bags are little-endian");

using Bytes = std::vector<std::byte>;

inline void append(Bytes& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

template <class Number>
requires std::is_integral_v<Number>
void append(Bytes& to, Number value) {
  append(to, std::as_bytes(std::span(&value, 1)));
}

/// The characters alone.
inline void append(Bytes& to, std::string_view text) {
  append(to, std::as_bytes(std::span(text)));
}

/// A count of bytes as u32, and the bytes.
inline void append_sized(Bytes& to, std::span<const std::byte> bytes) {
  append(to, static_cast<std::uint32_t>(bytes.size()));
  append(to, bytes);
}

inline void append_sized(Bytes& to, std::string_view text) {
  append_sized(to, std::as_bytes(std::span(text)));
}

/// Replaces a number that was appended before.
template <class Number>
void replace(Bytes& in, std::size_t at, Number value) {
  std::memcpy(in.data() + at, &value, sizeof value);
}

/// A bag that is open for reading at any place.
class BagFile {
 public:
  /// Throws Error when it is missing, no regular file or not readable.
  explicit BagFile(const std::filesystem::path& path);

  [[nodiscard]] std::uint64_t size() const { return file_.size; }
  /// The path and a byte offset, for errors.
  [[nodiscard]] std::string place(std::uint64_t offset) const;

  /// The bytes at an offset. They are valid until the next call. Throws Error when they are not all
  /// in the file; allocates no more than the file contains.
  std::span<const std::byte> peek(std::uint64_t offset, std::uint64_t size);
  /// The same, to keep, in the memory of `reused`.
  Bytes read(std::uint64_t offset, std::uint64_t size, Bytes reused = {});
  /// The same, into `to`. It reads ahead where the bytes follow those of the last call.
  void copy(std::uint64_t offset, std::span<std::byte> to);

 private:
  void require_within(std::uint64_t offset, std::uint64_t size) const;
  void read_at(std::uint64_t offset, std::span<std::byte> to) const;

  std::filesystem::path path_;
  InputFile file_;
  Bytes window_;  ///< bytes of the file, so that small records need no call of the system each
  std::uint64_t window_offset_ = 0;
  std::uint64_t copied_until_ = 0;
};

/// Size after which a chunk is written.
inline constexpr std::size_t kChunkBytes = std::size_t{4} << 20U;
/// Maximum size of a chunk that is read.
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1} << 29U;

/// Compresses a chunk into `to`, whose memory is reused. LZ4: one frame with independent blocks and
/// a checksum of the content, which is all that ROS 1 reads. Not for Compression::none.
void compress(std::span<const std::byte> chunk, Compression compression, Bytes& to);

/// Where a chunk is in its file.
struct StoredChunk {
  std::uint64_t offset = 0;  ///< of the records, which may be compressed
  std::uint64_t stored_size = 0;
  std::uint64_t size = 0;  ///< when it is decompressed
  Compression compression = Compression::none;
};

/// Reads and decompresses a chunk, in the memory of `reused`. Throws Error.
Bytes read_chunk(BagFile& file, const StoredChunk& chunk, InputBudget& budget, Bytes reused);

/// A chunk as a bag stores it.
struct PackedChunk {
  std::span<const std::byte> bytes;
  Compression compression = Compression::none;
  std::uint64_t size = 0;  ///< when it is decompressed
};

/// The chunk in the memory of `reused`. Throws Error, with `place`, unless it has its size, or when
/// it is larger than kMaxChunkBytes or the budget.
Bytes decompress(const PackedChunk& packed, InputBudget& budget, const std::string& place,
                 Bytes reused = {});

/// CRC-32 as zlib computes it, continued from `crc`.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t crc = 0);

/// The CRC of two byte strings after each other, from the CRC of each.
std::uint32_t combined_crc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size);

/// The budget of a bag, which all of its files share.
using SharedBudget = std::shared_ptr<InputBudget>;

/// A part of a bag with messages of any order. Times are in [first_ns, last_ns].
struct ChunkRange {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

/// A message in a chunk.
struct ChunkEntry {
  std::int64_t time_ns = 0;
  std::size_t topic = 0;
  std::size_t offset = 0;  ///< in LoadedChunk::bytes
  std::size_t size = 0;
};

struct LoadedChunk {
  Bytes bytes;
  std::vector<ChunkEntry> entries;
};

/// Merges the messages of chunks by time. A chunk is in memory only while its messages are due.
class ChunkMerger {
 public:
  /// Reads the chunk of a number, if possible in memory that an earlier chunk had.
  using Load = std::function<LoadedChunk(std::size_t number, Bytes reused)>;

  /// `place` is the path of the bag, for errors. Messages, and chunks while they are in memory,
  /// count in the budget.
  ChunkMerger(std::string place, std::vector<ChunkRange> chunks, SharedBudget budget, Load load);

  /// Keeps only messages of topics whose entry is true; before the first next().
  void select(std::vector<bool> topics) { selected_ = std::move(topics); }

  /// Throws Error when a message is outside its chunk's times, or the budget is exceeded, because
  /// too many chunks overlap.
  bool next(BagMessage& message);

 private:
  struct Open {
    std::size_t number = 0;
    LoadedChunk chunk;
    std::size_t entry = 0;  ///< the next one
  };

  void load_due();
  void open(std::size_t number);
  /// Of equal times, the first chunk in the file is the first.
  static bool is_later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b);

  std::string place_;
  std::vector<ChunkRange> chunks_;
  SharedBudget budget_;
  Load load_;
  std::vector<bool> selected_;               ///< empty: all
  std::vector<std::size_t> order_;           ///< chunks by first time
  std::size_t next_ = 0;                     ///< in order_
  std::vector<std::unique_ptr<Open>> open_;  ///< a heap; the earliest message is in front
  Bytes current_;  ///< of a chunk whose last message was returned; reused for the next chunk
};

/// A topic of a bag that is being written.
struct WrittenTopic {
  std::string name;
  const ros::MessageType* type = nullptr;
  ros::Qos qos;
  std::uint64_t messages = 0;
};

/// The topics of a bag and the times of its messages.
class WrittenTopics {
 public:
  /// `place` is the path of the bag, for errors.
  explicit WrittenTopics(std::string place) : place_(std::move(place)) {}

  /// Throws Error for a name that is in use or none of a topic.
  std::size_t add(const ros::Topic& topic);
  /// Counts a message. Throws Error for an unknown topic and a time before 1970.
  WrittenTopic& count(std::size_t topic, std::int64_t time_ns);

  [[nodiscard]] const std::vector<WrittenTopic>& all() const { return topics_; }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t first_ns() const { return first_ns_; }
  [[nodiscard]] std::uint64_t last_ns() const { return last_ns_; }

 private:
  std::string place_;
  std::vector<WrittenTopic> topics_;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t last_ns_ = 0;
};

}  // namespace glidar::bags

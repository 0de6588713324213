// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_storage.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <lz4frame.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <memory>
#include <numeric>
#include <system_error>
#include <utility>

namespace glidar::bags {

void reject_bag(const std::string& place, const std::string& found, const std::string& allowed) {
  throw Error({place, found, allowed, "the bag is damaged or incomplete; record or copy it again"});
}

namespace {

constexpr std::uint64_t kWindow = 1U << 16U;

InputFileKind bag_kind() {
  constexpr std::uintmax_t kNoLimit_mib = std::numeric_limits<std::uintmax_t>::max() >> 20U;
  return {"a bag", kNoLimit_mib, ""};
}

}  // namespace

BagFile::BagFile(const std::filesystem::path& path)
    : path_(path), file_(open_input_file(path, bag_kind())) {}

std::string BagFile::place(std::uint64_t offset) const {
  return fmt::format("{}, byte {}", path_.string(), offset);
}

std::span<const std::byte> BagFile::peek(std::uint64_t offset, std::uint64_t size) {
  require_within(offset, size);
  const bool is_held = offset >= window_offset_ && offset - window_offset_ <= window_.size() &&
                       size <= window_.size() - (offset - window_offset_);
  if (!is_held) {
    window_.resize(std::max(size, std::min(kWindow, file_.size - offset)));
    window_offset_ = offset;
    read_at(offset, window_);
  }
  return std::span(window_).subspan(offset - window_offset_, size);
}

Bytes BagFile::read(std::uint64_t offset, std::uint64_t size, Bytes reused) {
  require_within(offset, size);
  reused.resize(size);
  read_at(offset, reused);
  return reused;
}

void BagFile::copy(std::uint64_t offset, std::span<std::byte> to) {
  require_within(offset, to.size());
  const bool follows = offset >= copied_until_ && offset - copied_until_ < kWindow;
  copied_until_ = offset + to.size();
  if (!follows) return read_at(offset, to);
  std::ranges::copy(peek(offset, to.size()), to.begin());
}

void BagFile::require_within(std::uint64_t offset, std::uint64_t size) const {
  if (offset <= file_.size && size <= file_.size - offset) return;
  reject_bag(place(offset),
             fmt::format("{} bytes are missing",
                         size - (file_.size - std::min<std::uint64_t>(offset, file_.size))));
}

void BagFile::read_at(std::uint64_t offset, std::span<std::byte> to) const {
  while (!to.empty()) {
    const ssize_t count =
        ::pread(file_.descriptor.get(), to.data(), to.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw Error({path_.string(), "cannot read: " + std::generic_category().message(errno)});
    }
    if (count == 0) reject_bag(place(offset), "the file has become shorter");
    to = to.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

namespace {

/// LZ4 expands a byte to at most 255 (lz4_Block_format.md); zstd has no such limit.
constexpr std::uint64_t kMaxLz4Ratio = 256;

LZ4F_preferences_t lz4_preferences() {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  return preferences;
}

void compress_lz4(std::span<const std::byte> chunk, Bytes& to) {
  const LZ4F_preferences_t preferences = lz4_preferences();
  to.resize(LZ4F_compressFrameBound(chunk.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(to.data(), to.size(), chunk.data(), chunk.size(), &preferences);
  if (LZ4F_isError(size) != 0U)
    throw Error({"LZ4", std::string("cannot compress: ") + LZ4F_getErrorName(size)});
  to.resize(size);
}

void compress_zstd(std::span<const std::byte> chunk, Bytes& to) {
  constexpr int kFast = 1;
  to.resize(ZSTD_compressBound(chunk.size()));
  const std::size_t size = ZSTD_compress(to.data(), to.size(), chunk.data(), chunk.size(), kFast);
  if (ZSTD_isError(size) != 0U)
    throw Error({"Zstandard", std::string("cannot compress: ") + ZSTD_getErrorName(size)});
  to.resize(size);
}

Bytes decompress_lz4(std::span<const std::byte> packed, std::uint64_t size,
                     const std::string& place, Bytes chunk) {
  if (size / kMaxLz4Ratio > packed.size())
    reject_bag(place, fmt::format("{} bytes that claim to be {}", packed.size(), size));
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U)
    throw Error({place, "cannot decompress LZ4"});
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      made, LZ4F_freeDecompressionContext);
  chunk.resize(size);
  std::size_t done = 0;
  for (;;) {
    std::size_t written = chunk.size() - done;
    std::size_t read = packed.size();
    const std::size_t hint = LZ4F_decompress(context.get(), chunk.data() + done, &written,
                                             packed.data(), &read, nullptr);
    if (LZ4F_isError(hint) != 0U)
      reject_bag(place, std::string("damaged LZ4 data: ") + LZ4F_getErrorName(hint));
    done += written;
    packed = packed.subspan(read);
    if (hint == 0 || (written == 0 && read == 0)) {
      if (hint == 0 && packed.empty() && done == chunk.size()) return chunk;
      reject_bag(place, "LZ4 data of another size", fmt::format("{} bytes", size));
    }
  }
}

Bytes decompress_zstd(std::span<const std::byte> packed, std::uint64_t size,
                      const std::string& place, Bytes chunk) {
  const unsigned long long known = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (known == ZSTD_CONTENTSIZE_ERROR || (known != ZSTD_CONTENTSIZE_UNKNOWN && known > size))
    reject_bag(place, "damaged Zstandard data");
  chunk.resize(size);
  const std::size_t done =
      ZSTD_decompress(chunk.data(), chunk.size(), packed.data(), packed.size());
  if (ZSTD_isError(done) != 0U)
    reject_bag(place, std::string("damaged Zstandard data: ") + ZSTD_getErrorName(done));
  if (done != size)
    reject_bag(place, fmt::format("{} bytes of Zstandard data", done), fmt::format("{}", size));
  return chunk;
}

}  // namespace

void compress(std::span<const std::byte> chunk, Compression compression, Bytes& to) {
  if (compression == Compression::lz4) return compress_lz4(chunk, to);
  compress_zstd(chunk, to);
}

Bytes decompress(const PackedChunk& packed, InputBudget& budget, const std::string& place,
                 Bytes reused) {
  const auto& [bytes, compression, size] = packed;
  if (compression == Compression::none) {
    if (bytes.size() != size)
      reject_bag(place, fmt::format("{} bytes that claim to be {}", bytes.size(), size));
    return {bytes.begin(), bytes.end()};
  }
  const std::uint64_t max_size = std::min(kMaxChunkBytes, budget.limit(Budget::held_bytes));
  if (size > max_size) {
    reject_bag(place, fmt::format("a chunk of {} bytes", size),
               fmt::format("at most {} bytes in a bag of this size", max_size));
  }
  budget.take(Budget::decompressed_bytes, size, place);
  if (compression == Compression::lz4) return decompress_lz4(bytes, size, place, std::move(reused));
  return decompress_zstd(bytes, size, place, std::move(reused));
}

Bytes read_chunk(BagFile& file, const StoredChunk& chunk, InputBudget& budget, Bytes reused) {
  if (chunk.compression == Compression::none && chunk.size == chunk.stored_size)
    return file.read(chunk.offset, chunk.size, std::move(reused));
  const Bytes stored = file.read(chunk.offset, chunk.stored_size);
  return decompress({stored, chunk.compression, chunk.size}, budget, file.place(chunk.offset),
                    std::move(reused));
}

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t crc) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t combined_crc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size) {
  return static_cast<std::uint32_t>(
      crc32_combine(first, second, static_cast<z_off_t>(second_size)));
}

ChunkMerger::ChunkMerger(std::string place, std::vector<ChunkRange> chunks, SharedBudget budget,
                         Load load)
    : place_(std::move(place)),
      chunks_(std::move(chunks)),
      budget_(std::move(budget)),
      load_(std::move(load)) {
  order_.resize(chunks_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return chunks_[a].first_ns < chunks_[b].first_ns;
  });
}

bool ChunkMerger::next(BagMessage& message) {
  load_due();
  if (open_.empty()) return false;
  std::pop_heap(open_.begin(), open_.end(), is_later);
  Open& from = *open_.back();
  const ChunkEntry& entry = from.chunk.entries[from.entry];
  message.topic = entry.topic;
  message.time_ns = entry.time_ns;
  message.data = std::span(from.chunk.bytes).subspan(entry.offset, entry.size);
  if (++from.entry == from.chunk.entries.size()) {
    budget_->give_back(Budget::held_bytes, from.chunk.bytes.size());
    current_ = std::move(from.chunk.bytes);  // moving a vector keeps its bytes in place
    open_.pop_back();
  } else {
    std::push_heap(open_.begin(), open_.end(), is_later);
  }
  return true;
}

/// Opens every chunk that may contain the next message.
void ChunkMerger::load_due() {
  while (next_ < order_.size()) {
    if (!open_.empty()) {
      const Open& first = *open_.front();
      if (chunks_[order_[next_]].first_ns > first.chunk.entries[first.entry].time_ns) return;
    }
    open(order_[next_++]);
  }
}

void ChunkMerger::open(std::size_t number) {
  auto opened = std::make_unique<Open>();
  opened->number = number;
  opened->chunk = load_(number, std::exchange(current_, {}));
  std::vector<ChunkEntry>& entries = opened->chunk.entries;
  budget_->take(Budget::messages, entries.size(), place_);
  const ChunkRange& range = chunks_[number];
  for (const ChunkEntry& entry : entries) {
    if (entry.time_ns >= range.first_ns && entry.time_ns <= range.last_ns) continue;
    reject_bag(place_, fmt::format("a message at {} ns in a chunk of {} to {} ns", entry.time_ns,
                                   range.first_ns, range.last_ns));
  }
  if (!selected_.empty())
    std::erase_if(entries, [&](const ChunkEntry& entry) { return !selected_[entry.topic]; });
  if (entries.empty()) return;
  std::stable_sort(entries.begin(), entries.end(),
                   [](const ChunkEntry& a, const ChunkEntry& b) { return a.time_ns < b.time_ns; });
  if (!budget_->try_take(Budget::held_bytes, opened->chunk.bytes.size())) {
    throw Error({place_,
                 fmt::format("chunks of more than {} bytes whose times overlap",
                             budget_->limit(Budget::held_bytes)),
                 "messages that are roughly in order of time", "sort the bag"});
  }
  open_.push_back(std::move(opened));
  std::push_heap(open_.begin(), open_.end(), is_later);
}

bool ChunkMerger::is_later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b) {
  const auto key = [](const Open& open) {
    return std::pair(open.chunk.entries[open.entry].time_ns, open.number);
  };
  return key(*a) > key(*b);
}

namespace {

constexpr std::size_t kMaxTopics = 65000;  // channels of MCAP have numbers of 16 bits

/// Names of ROS: design.ros2.org/articles/topic_and_service_names.html.
bool is_topic_name(const std::string& name) {
  const auto is_valid = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  return name.size() > 1 && name.front() == '/' && name.back() != '/' &&
         name.find("//") == std::string::npos && std::all_of(name.begin(), name.end(), is_valid);
}

}  // namespace

std::size_t WrittenTopics::add(const ros::Topic& topic) {
  if (!is_topic_name(topic.name)) {
    throw Error({place_, "a topic '" + excerpt(topic.name) + "'",
                 "'/' and letters, digits, '_' and '/'", "name it /points, for example"});
  }
  const auto is_same = [&](const WrittenTopic& known) { return known.name == topic.name; };
  if (std::any_of(topics_.begin(), topics_.end(), is_same))
    throw Error({place_, "the topic " + topic.name + " a second time", "each topic once"});
  if (topic.type == nullptr) throw Error({place_, "the topic " + topic.name + " without a type"});
  if (topics_.size() == kMaxTopics)
    throw Error({place_, "more topics", fmt::format("at most {}", kMaxTopics)});
  topics_.push_back({topic.name, topic.type, topic.qos, 0});
  return topics_.size() - 1;
}

WrittenTopic& WrittenTopics::count(std::size_t topic, std::int64_t time_ns) {
  if (topic >= topics_.size())
    throw Error({place_, fmt::format("a message of topic {}", topic), "a topic that was added"});
  if (time_ns < 0) {
    throw Error({place_, fmt::format("a message at {} ns", time_ns), "times since 1970",
                 "start the simulation at 0 or later"});
  }
  const auto time = static_cast<std::uint64_t>(time_ns);
  first_ns_ = messages_ == 0 ? time : std::min(first_ns_, time);
  last_ns_ = std::max(last_ns_, time);
  ++messages_;
  ++topics_[topic].messages;
  return topics_[topic];
}

}  // namespace glidar::bags

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/record_stream.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace glidar {

struct SharedRing::Shared {
  std::atomic<std::uint32_t> taken;       ///< modulo 2^32
  std::atomic<std::uint32_t> is_waiting;  ///< the end that puts, for space
  alignas(4096) std::array<std::byte, kBytes> bytes;
};

namespace {

/// The standard's wait() and notify_one() work within one process only.
void futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  ::syscall(SYS_futex, &word, operation, value, nullptr, nullptr, 0);
}

}  // namespace

int SharedRing::create() {
  const int memory = ::memfd_create("glidar-records", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  constexpr int kFixedSize = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
  if (memory < 0 ||
      (::ftruncate(memory, sizeof(Shared)) == 0 && ::fcntl(memory, F_ADD_SEALS, kFixedSize) == 0))
    return memory;
  const int error = errno;
  ::close(memory);
  errno = error;
  return -1;
}

SharedRing::SharedRing(int fd) {
  void* mapped = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (mapped == MAP_FAILED) throw Error({"shared memory", std::generic_category().message(errno)});
  shared_ = static_cast<Shared*>(mapped);
}

SharedRing::~SharedRing() {
  ::munmap(shared_, sizeof(Shared));
}

std::uint32_t SharedRing::space() const {
  return kBytes - (at_ - shared_->taken.load());
}

std::size_t SharedRing::put(std::size_t size, CopyPayload copy) {
  const std::size_t count = std::min<std::size_t>(size, space());
  const std::size_t start = at_ % kBytes;
  const std::size_t first = std::min(count, kBytes - start);
  const std::span<std::byte> bytes(shared_->bytes);
  copy(0, bytes.subspan(start, first));
  if (first < count) copy(first, bytes.first(count - first));
  at_ += static_cast<std::uint32_t>(count);
  return count;
}

void SharedRing::wait_for_space() {
  while (space() == 0) {
    shared_->is_waiting = 1;
    // returns at once when bytes were taken meanwhile
    futex(shared_->taken, FUTEX_WAIT, at_ - kBytes);
  }
}

void SharedRing::take(std::span<std::byte> to) {
  const std::size_t start = at_ % kBytes;
  const std::size_t first = std::min(to.size(), kBytes - start);
  std::memcpy(to.data(), shared_->bytes.data() + start, first);
  std::memcpy(to.data() + first, shared_->bytes.data(), to.size() - first);
  at_ += static_cast<std::uint32_t>(to.size());
  shared_->taken = at_;
  if (shared_->is_waiting.exchange(0) != 0) futex(shared_->taken, FUTEX_WAKE, 1);
}

namespace {

constexpr std::size_t kBufferBytes = std::size_t{256} << 10U;
constexpr std::size_t kMaxFailureBytes = std::size_t{64} << 10U;
constexpr std::size_t kMinRingPayload = std::size_t{4} << 10U;
constexpr std::uint32_t kMaxPiece = SharedRing::kBytes / 4;
constexpr std::uint32_t kAbandoned = 0;  ///< instead of a piece: the record ends, a failure follows

bool is_in_ring(RecordKind kind, std::uint64_t size) {
  return kind != RecordKind::failure && size >= kMinRingPayload;
}

/// A record in the stream, before its payload. Both ends are on one machine.
struct RecordHead {
  std::uint32_t kind = 0;
  std::uint32_t index = 0;
  std::int64_t stamp_ns = 0;
  std::uint64_t size = 0;
};
static_assert(sizeof(RecordHead) == 24);

void append_bytes(std::vector<std::byte>& to, const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(from);
  to.insert(to.end(), bytes, bytes + size);
}

}  // namespace

/// Small records are collected. At first each is sent at once, so that a reader of the first
/// message need not wait until thousands are read.
void RecordWriter::write(const Record& record) {
  const auto copy = [&](std::size_t offset, std::span<std::byte> to) {
    std::ranges::copy(record.payload.subspan(offset, to.size()), to.begin());
  };
  write(record, record.payload.size(), CopyPayload(copy));
}

void RecordWriter::write(const Record& record, std::size_t size, CopyPayload copy) {
  const RecordHead head{static_cast<std::uint32_t>(record.kind), record.index, record.stamp_ns,
                        size};
  const std::size_t before = buffer_.size();
  append_bytes(buffer_, &head, sizeof head);
  if (ring_ != nullptr && is_in_ring(record.kind, size)) {
    put_in_ring(size, copy);
  } else {
    buffer_.resize(buffer_.size() + size);
    try {
      copy(0, std::span(buffer_).last(size));
    } catch (...) {
      buffer_.resize(before);
      throw;
    }
  }
  ++records_;
  if (buffer_.size() >= kBufferBytes || records_ - flushed_records_ > flushed_records_) flush();
}

void RecordWriter::write_failure(const ErrorParts& parts) {
  std::vector<std::byte> payload;
  for (const std::string* part : {&parts.where, &parts.found, &parts.allowed, &parts.remedy}) {
    const std::string text = part->substr(0, kMaxFailureBytes / 5);
    const auto size = static_cast<std::uint32_t>(text.size());
    append_bytes(payload, &size, sizeof size);
    append_bytes(payload, text.data(), text.size());
  }
  write({RecordKind::failure, 0, 0, payload});
  flush();
}

/// The reader must know of all bytes before this waits for space.
void RecordWriter::put_in_ring(std::size_t size, CopyPayload copy) {
  for (std::size_t sent = 0; sent < size;) {
    const auto copy_rest = [&](std::size_t offset, std::span<std::byte> to) {
      copy(sent + offset, to);
    };
    std::uint32_t piece = 0;
    try {
      piece = static_cast<std::uint32_t>(
          ring_->put(std::min<std::size_t>(size - sent, kMaxPiece), CopyPayload(copy_rest)));
    } catch (...) {
      append_bytes(buffer_, &kAbandoned, sizeof kAbandoned);
      throw;
    }
    if (piece != 0) append_bytes(buffer_, &piece, sizeof piece);
    sent += piece;
    ring_bytes_ += piece;
    if (piece == 0 || ring_bytes_ >= kMaxPiece) flush();
    if (piece == 0) ring_->wait_for_space();
  }
}

void RecordWriter::flush() {
  write_all(buffer_);
  buffer_.clear();
  ring_bytes_ = 0;
  flushed_records_ = records_;
}

void RecordWriter::write_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error({"stream", std::generic_category().message(errno)});
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

RecordReader::RecordReader(Source source, std::string place, std::uint64_t max_payload,
                           std::shared_ptr<SharedRing> ring)
    : source_(std::move(source)),
      place_(std::move(place)),
      max_payload_(max_payload),
      ring_(std::move(ring)),
      buffer_(kBufferBytes) {}

void RecordReader::reject(const std::string& found) const {
  throw Error({place_, "the process that reads it returned a malformed answer (" + found + ")", "",
               "the file is damaged or malicious"});
}

Record RecordReader::take_head(std::uint64_t& size) {
  RecordHead head;
  take(std::as_writable_bytes(std::span(&head, 1)));
  if (head.kind < static_cast<std::uint32_t>(RecordKind::topic) ||
      head.kind > static_cast<std::uint32_t>(RecordKind::failure))
    reject(fmt::format("a record of kind {}", head.kind));
  const auto kind = static_cast<RecordKind>(head.kind);
  const std::uint64_t max_size = kind == RecordKind::item      ? max_payload_
                                 : kind == RecordKind::failure ? kMaxFailureBytes
                                                               : 3 * InputBudget::kMaxNameBytes;
  if (head.size > max_size) reject(fmt::format("a record of {} bytes", head.size));
  size = head.size;
  return {kind, head.index, head.stamp_ns, {}};
}

Record RecordReader::next() {
  std::uint64_t size = 0;
  Record record = take_head(size);
  record.payload =
      ring_ != nullptr && is_in_ring(record.kind, size) ? take_from_ring(size) : take_payload(size);
  if (record.kind == RecordKind::failure) rethrow(record.payload);
  return record;
}

void RecordReader::take_failure() {
  std::uint64_t size = 0;
  if (take_head(size).kind != RecordKind::failure) reject("a record without its end");
  rethrow(take_payload(size));
}

/// Fills all bytes.
void RecordReader::take(std::span<std::byte> to) {
  while (!to.empty()) {
    const std::size_t held = std::min(end_ - begin_, to.size());
    std::memcpy(to.data(), buffer_.data() + begin_, held);
    begin_ += held;
    to = to.subspan(held);
    if (to.empty()) return;
    const bool is_large = to.size() >= buffer_.size();
    const std::size_t got = source_(is_large ? to : std::span(buffer_));
    if (got == 0) reject("it ends early");
    if (is_large) {
      to = to.subspan(got);
    } else {
      begin_ = 0;
      end_ = got;
    }
  }
}

/// A claimed size alone takes no memory: the buffer grows as the bytes arrive.
void RecordReader::make_room(std::size_t bytes, std::uint64_t size) {
  constexpr std::size_t kFirst = std::size_t{1} << 20U;
  if (payload_.size() < bytes)
    payload_.resize(std::min<std::size_t>(size, std::max(kFirst, 2 * bytes)));
}

std::span<const std::byte> RecordReader::take_from_ring(std::uint64_t size) {
  for (std::size_t filled = 0; filled < size;) {
    std::uint32_t piece = 0;
    take(std::as_writable_bytes(std::span(&piece, 1)));
    if (piece == kAbandoned) take_failure();
    if (piece > std::min<std::uint64_t>(kMaxPiece, size - filled))
      reject(fmt::format("a piece of {} bytes", piece));
    make_room(filled + piece, size);
    ring_->take(std::span(payload_).subspan(filled, piece));
    filled += piece;
  }
  return std::span(payload_).first(size);
}

std::span<const std::byte> RecordReader::take_payload(std::uint64_t size) {
  if (size <= end_ - begin_) {
    begin_ += size;
    return std::span(buffer_).subspan(begin_ - size, size);
  }
  for (std::size_t filled = 0; filled < size;) {
    make_room(filled + 1, size);
    const std::size_t until = std::min<std::size_t>(size, payload_.size());
    take(std::span(payload_).subspan(filled, until - filled));
    filled = until;
  }
  return std::span(payload_).first(size);
}

void RecordReader::rethrow(std::span<const std::byte> payload) const {
  std::array<std::string, 4> parts;
  for (std::string& part : parts) {
    std::uint32_t size = 0;
    if (payload.size() < sizeof size) reject("an error that ends early");
    std::memcpy(&size, payload.data(), sizeof size);
    payload = payload.subspan(sizeof size);
    if (payload.size() < size) reject("an error that ends early");
    constexpr std::size_t kMaxPart = 8192;
    part = excerpt({reinterpret_cast<const char*>(payload.data()), size}, kMaxPart);
    payload = payload.subspan(size);
  }
  throw Error({parts[0], parts[1], parts[2], parts[3]});
}

}  // namespace glidar

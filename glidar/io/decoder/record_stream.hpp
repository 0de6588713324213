// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/core/function_ref.hpp>
#include <glidar/io/files/input_file.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// Copies bytes of a payload, from an offset on, and as many as there are in `to`.
using CopyPayload = FunctionRef<void(std::size_t offset, std::span<std::byte> to)>;

/// A ring of bytes in memory that two processes share: one of them puts bytes, the other one takes
/// them, and a pipe between them states how many there are. It costs less than half of a pipe,
/// which allocates its pages for each write.
class SharedRing {
 public:
  static constexpr std::uint32_t kBytes = std::uint32_t{1} << 19U;

  /// Creates the memory, whose size cannot change: a descriptor, or -1 and errno.
  static int create();
  /// Maps it, at both ends. Throws Error.
  explicit SharedRing(int fd);
  SharedRing(const SharedRing&) = delete;
  SharedRing& operator=(const SharedRing&) = delete;
  ~SharedRing();

  /// Copies the first of `size` bytes, as many as there is space for, and returns how many.
  std::size_t put(std::size_t size, CopyPayload copy);
  /// Waits until the other end takes bytes, if there is no space.
  void wait_for_space();

  /// Copies as many bytes, which the other end has put. It reads nothing else that the other end
  /// can change, so a malicious one can only send other bytes.
  void take(std::span<std::byte> to);

 private:
  struct Shared;
  [[nodiscard]] std::uint32_t space() const;

  Shared* shared_;
  std::uint32_t at_ = 0;  ///< bytes that this end has put or taken, modulo 2^32
};

enum class RecordKind : std::uint32_t {
  topic = 1,  ///< of a bag; all come first, in order
  ready,      ///< all topics are sent; the reader requests some of them
  item,       ///< a message of a bag, a datagram of a capture, or the pixels of an image
  end,
  failure,  ///< the error that ended the reading
};

/// One record; in the stream these numbers, the size and the bytes of the payload. Those of a long
/// payload are in the shared memory, if there is one, and the stream has the sizes of its pieces.
struct Record {
  RecordKind kind = RecordKind::end;
  std::uint32_t index = 0;    ///< of the item's topic, or what its kind of input needs
  std::int64_t stamp_ns = 0;  ///< of an item
  std::span<const std::byte> payload;
};

class RecordWriter {
 public:
  explicit RecordWriter(int fd, SharedRing* ring = nullptr) : fd_(fd), ring_(ring) {}

  /// Throws Error when the stream cannot be written.
  void write(const Record& record);
  /// The same with a payload of `size` bytes that need not be in memory.
  /// What `copy` throws ends the stream; the reader gets the failure that is written next.
  void write(const Record& record, std::size_t size, CopyPayload copy);
  void write_failure(const ErrorParts& parts);
  void flush();

 private:
  void put_in_ring(std::size_t size, CopyPayload copy);
  void write_all(std::span<const std::byte> bytes);

  int fd_;
  SharedRing* ring_;
  std::size_t ring_bytes_ = 0;  ///< since the last flush
  std::vector<std::byte> buffer_;
  std::size_t flushed_records_ = 0;
  std::size_t records_ = 0;
};

/// Reads records of a process that a malicious file may have compromised: checks every number and
/// size, and keeps memory within the budget of the input.
class RecordReader {
 public:
  /// Fills some of the bytes and returns how many; 0 at the end of the stream.
  using Source = std::function<std::size_t(std::span<std::byte>)>;

  /// `place` names the input in errors. `max_payload`: bytes of a record.
  RecordReader(Source source, std::string place, std::uint64_t max_payload,
               std::shared_ptr<SharedRing> ring = nullptr);

  /// The next record, whose payload is valid until the next call. Throws the Error that the process
  /// reports, and Error when the stream is malformed or ends without its last record.
  Record next();

  [[noreturn]] void reject(const std::string& found) const;
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  Record take_head(std::uint64_t& size);
  void take(std::span<std::byte> to);
  [[noreturn]] void take_failure();
  std::span<const std::byte> take_payload(std::uint64_t size);
  std::span<const std::byte> take_from_ring(std::uint64_t size);
  void make_room(std::size_t bytes, std::uint64_t size);
  [[noreturn]] void rethrow(std::span<const std::byte> payload) const;

  Source source_;
  std::string place_;
  std::uint64_t max_payload_;
  std::shared_ptr<SharedRing> ring_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;  ///< of the bytes of buffer_ that were not returned yet
  std::size_t end_ = 0;
  std::vector<std::byte> payload_;  ///< of a record that is larger than the rest of the buffer
};

}  // namespace glidar

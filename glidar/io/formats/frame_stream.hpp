// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/content_hash.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// What a frame holds.
enum class FrameKind : std::uint32_t { model = 1, failure = 2, cached_file = 3 };

/// The head of a frame: bytes that a file or a pipe's memory holds as one checked piece.
/// Little-endian machines only (all that GLIDAR supports), checked through `mark`.
struct FrameHead {
  std::uint64_t mark = 0;
  std::uint32_t version = 0;
  std::uint32_t kind = 0;
  std::uint64_t size = 0;  ///< bytes after the head
  Hash128 hash{};          ///< XXH3-128 of them
};

/// Writes one frame at the file's position. The head is completed by finish().
/// Throws Error when the file takes no more.
class FrameWriter {
 public:
  FrameWriter(int fd, FrameKind kind);
  void bytes(const void* data, std::size_t size);
  void finish();

 private:
  void flush();

  int fd_;
  FrameKind kind_;
  std::int64_t head_at_;
  std::uint64_t size_ = 0;
  ContentHash hash_;
  std::vector<std::byte> buffer_;
};

/// Reads one frame at the file's position. Trusts nothing: throws Error when the head is not that
/// of a frame of this version, when it tells more bytes than the file has, when more is asked for
/// than is left, and when the hash does not fit.
class FrameReader {
 public:
  explicit FrameReader(int fd);
  [[nodiscard]] FrameKind kind() const { return static_cast<FrameKind>(head_.kind); }
  /// Bytes not yet read: bounds every count before memory is taken for it.
  [[nodiscard]] std::uint64_t remaining() const { return head_.size - taken_; }
  void bytes(void* data, std::size_t size);
  /// Checks that everything was read and the hash; leaves the file's position after the frame.
  void finish();

 private:
  void fill();

  int fd_;
  FrameHead head_;
  std::uint64_t taken_ = 0;    ///< handed out
  std::uint64_t fetched_ = 0;  ///< read from the file
  ContentHash hash_;
  std::vector<std::byte> buffer_;
  std::size_t next_ = 0;  ///< in buffer_
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/io/files/content_hash.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// The content of a block.
enum class BlockKind : std::uint32_t { model = 1, failure = 2, cached_file = 3 };

/// The header of a block of bytes with a checksum, in a file or memory file.
/// Little-endian machines only (all that GLIDAR supports), checked by `magic`.
struct BlockHead {
  std::uint64_t magic = 0;
  std::uint32_t version = 0;
  std::uint32_t kind = 0;
  std::uint64_t size = 0;  ///< bytes after the head
  Hash128 hash{};          ///< XXH3-128 of them
};

/// Throws Error for malformed data of the import process or the model cache.
[[noreturn]] void reject_imported_data(const std::string& found);

/// A file would exceed the limit on the size of files (RLIMIT_FSIZE).
class FileSizeLimit : public Error {
 public:
  using Error::Error;
};

/// Writes one block at the file's position. finish() completes the header.
/// Throws Error when the file cannot be written; FileSizeLimit if that is the reason.
class BlockWriter {
 public:
  BlockWriter(int fd, BlockKind kind);
  void bytes(const void* data, std::size_t size);
  void finish();

 private:
  void flush();

  int fd_;
  BlockKind kind_;
  std::int64_t head_at_;
  std::uint64_t size_ = 0;
  ContentHash hash_;
  std::vector<std::byte> buffer_;
};

/// Reads one block at the file's position. Trusts nothing: throws Error when the header is not that
/// of a block of this version, when it claims more bytes than the file has, when more is requested
/// than remains, and when the hash differs.
class BlockReader {
 public:
  explicit BlockReader(int fd);
  [[nodiscard]] BlockKind kind() const { return static_cast<BlockKind>(head_.kind); }
  /// Bytes not yet read: bounds every count before memory is allocated for it.
  [[nodiscard]] std::uint64_t remaining() const { return head_.size - taken_; }
  void bytes(void* data, std::size_t size);
  /// Checks that everything was read, and the hash; moves the file's position to the end of the
  /// block.
  void finish();

 private:
  void fill();

  int fd_;
  BlockHead head_;
  std::uint64_t taken_ = 0;    ///< returned to the caller
  std::uint64_t fetched_ = 0;  ///< read from the file
  ContentHash hash_;
  std::vector<std::byte> buffer_;
  std::size_t next_ = 0;  ///< in buffer_
};

}  // namespace glidar

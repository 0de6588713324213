// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/byte_writer.hpp>
#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace glidar::bags {

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

}  // namespace glidar::bags

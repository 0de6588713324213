// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace glidar {

/// The reader has closed the other end of a pipe, as with `| head`.
class ClosedPipe : public Error {
 public:
  using Error::Error;
};

/// A file that appears under its name only when it is complete: bytes are written to a temporary
/// file in the same folder, which commit() renames. It has no name until then where the file system
/// has such files, so that a program that is killed leaves nothing. Without commit() the destructor
/// removes the temporary file and an existing file stays unchanged. If the path
/// is a symbolic link, its target is written and the link stays. Writes are buffered and flushed in
/// large blocks at multiples of the block size, which is fastest for file systems.
class AtomicFile {
 public:
  /// Who may read the file: everyone whom the user's umask allows, or its owner only.
  enum class Permissions : std::uint8_t { by_umask, owner_only };
  /// Throws Error when `path` exists and is not a regular file (a folder, a device), or no file can
  /// be created in its folder.
  explicit AtomicFile(const std::filesystem::path& path,
                      Permissions permissions = Permissions::by_umask);
  /// The same for an open file descriptor that stays open, such as standard output: commit()
  /// writes the bytes to it, in order. `name` appears in errors.
  AtomicFile(int target, const std::filesystem::path& name);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends at the current position. Throws Error (disk full, quota, input/output error), and then
  /// again at every further call: an incomplete file is never renamed.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Buffer space for at least `min_size` bytes, to be filled in place; take() then appends
  /// the first `count`. Throws as write() does.
  std::span<std::byte> reserve_space(std::size_t min_size);
  void take(std::size_t count);

  /// Moves to a byte offset from the start. Throws Error when the file cannot seek.
  void seek(std::uint64_t offset);
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// Writes everything, so that several files can all be complete before the first one is renamed.
  /// Throws Error when a byte could not be stored.
  void finish();

  /// finish(), then renames the file, which replaces an existing one atomically. Throws Error;
  /// ClosedPipe when the target is a pipe that its reader has closed.
  void commit();

  /// Instead of finish() and commit(), for a file that survives power loss: the
  /// bytes are on the disk before the file gets its name, and the name when this returns. Throws
  /// Error also when the disk cannot confirm one of them; if that is the name, the file is in
  /// place. Bytes that commit() writes to an open file descriptor are not synced.
  void commit_durably();

  /// The name the file will have.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void flush();
  void write_whole_pieces();
  void write_through(std::span<const std::byte> bytes);
  void send() const;
  void close_named();

  std::filesystem::path path_;
  std::filesystem::path destination_;  ///< absolute; not a symbolic link
  std::filesystem::path temporary_;    ///< absolute; empty: it has no name, or it is committed
  int descriptor_ = -1;                ///< -1 once closed
  int target_ = -1;                    ///< where commit() writes the bytes; -1: none, it renames
  int failure_ = 0;                    ///< errno of the first write that failed
  int slot_ = -1;                      ///< in the list for remove_unfinished_files, -1: not in it
  std::uint64_t position_ = 0;
  std::vector<std::byte> buffer_;  ///< a block, and space for bytes beyond its end
  std::size_t filled_ = 0;         ///< bytes of the buffer in use
};

/// Removes the temporary files of every AtomicFile that is not committed. For a program that is
/// about to end because of a signal: it is async-signal-safe. Afterwards commit() of those with a
/// temporary name fails.
/// Covers the first 128 files open at a time with paths below 4096 bytes.
void remove_unfinished_files() noexcept;

}  // namespace glidar

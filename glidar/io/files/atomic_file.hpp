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

/// Nobody reads the other end of a pipe any more, as with `| head`.
class ClosedPipe : public Error {
 public:
  using Error::Error;
};

/// A file that appears under its name only when it is whole: bytes go to a temporary file in the
/// same folder, commit() renames it. Without commit() the destructor removes the temporary file and
/// whatever stood under the name stays. Writes are gathered and go out in large pieces that start
/// at multiples of their size, which file systems take fastest.
class AtomicFile {
 public:
  /// Who may read the file: all that the user's mask lets, or its owner alone.
  enum class Readers : std::uint8_t { usual, owner };
  /// Throws Error when `path` is there and no regular file (a folder, a device), or no file can be
  /// made beside it.
  explicit AtomicFile(const std::filesystem::path& path, Readers readers = Readers::usual);
  /// The same for an open file of the system that stays open, such as standard output: commit()
  /// sends it the bytes, in order. `name` appears in errors.
  AtomicFile(int target, const std::filesystem::path& name);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends at the current position. Throws Error (disk full, quota, input/output error), and then
  /// again at every further call: a file with a gap is never put in place.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Room for the next bytes, at least `least` of them, to be filled in place; take() then appends
  /// the first `count`. Throws as write() does.
  std::span<std::byte> room(std::size_t least);
  void take(std::size_t count);

  /// Moves to a byte offset from the start. Throws Error when the file cannot seek.
  void seek(std::uint64_t offset);
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// Hands everything to the system and closes the temporary file, so that of several files all can
  /// be complete before the first is renamed. Throws Error when a byte could not be stored.
  void finish();

  /// finish(), then gives the file its name, replacing what was there in one step. Throws Error;
  /// ClosedPipe when it was to go to a pipe that nobody reads.
  void commit();

  /// In the place of finish() and commit(), for a file that a loss of power does not undo: the
  /// bytes are on the disk before the file gets its name, and the name when this returns. Throws
  /// Error also when the disk cannot confirm one of them; where that is the name, the file is in
  /// place. What commit() sends to an open file of the system is not synced.
  void commit_durably();

  /// The name the file will have.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void flush();
  void write_whole_pieces();
  void write_through(std::span<const std::byte> bytes);
  void send() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< absolute; empty once committed
  int descriptor_ = -1;              ///< -1 once finished
  int target_ = -1;                  ///< where commit() sends the bytes; -1: nowhere, it renames
  int failure_ = 0;                  ///< errno of the first write that failed
  int slot_ = -1;                    ///< in the list for remove_unfinished_files, -1: not in it
  std::uint64_t position_ = 0;
  std::vector<std::byte> buffer_;  ///< a piece, and room beyond it for what straddles its end
  std::size_t filled_ = 0;         ///< bytes of the buffer in use
};

/// Removes the temporary files of every AtomicFile that is not committed. For a program that is
/// about to end because of a signal: it is async-signal-safe. Afterwards commit() of those fails.
/// Covers the first 128 files open at a time with paths below 4096 bytes.
void remove_unfinished_files() noexcept;

}  // namespace glidar

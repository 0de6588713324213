// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/core/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Lists a temporary file, or a folder of such files, which must be listed before them. Returns its
/// slot; -1 when the list is full or the path is too long.
int list_unfinished(const std::string& path);

/// Takes a file from the list; a slot of -1 is ignored.
void unlist_unfinished(int slot);

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

/// The path without symbolic links in its folders; "..", also after a link, as the system resolves
/// it.
std::filesystem::path real_path(const std::filesystem::path& path);

/// True for two names of one file, also if it does not exist yet.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// All files that the models of a scene were read from: including textures, materials and buffers.
std::vector<std::string> files_of(const Scene& scene);

/// Throws Error when `output` is an input file.
void refuse_overwrite_of_inputs(std::span<const std::string> read,
                                const std::filesystem::path& output);

/// Files that are renamed together when all of them are complete. Without commit() the
/// destructor removes them and the folders that were created for them.
class StagedFiles {
 public:
  StagedFiles() = default;
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;
  ~StagedFiles() { clear(); }

  /// Files that must not be overwritten.
  void protect(std::span<const std::string> read) { protected_.assign(read.begin(), read.end()); }
  /// Commits without a lock: the caller holds one that excludes other programs.
  void set_locked() { is_locked_ = true; }
  /// A new file, to be written to and finished by the caller. Throws Error like AtomicFile, and
  /// when it would overwrite a protected file.
  AtomicFile& add(const std::filesystem::path& path);
  /// The same for an open file descriptor, to which the bytes are written.
  AtomicFile& add(int target, const std::filesystem::path& name) {
    return files_.emplace_back(target, name);
  }
  /// Removes a regular file at commit(), if it exists: one of an earlier output that does
  /// not belong to the new files.
  void remove(const std::filesystem::path& path) { removals_.push_back(path); }
  /// Creates a folder unless it exists. A signal that ends the program removes it again, if it is
  /// empty. Throws Error.
  void add_folder(const std::filesystem::path& path);
  /// Removes outdated files, then renames the files, the first one last, so that
  /// the others exist when it appears. Programs that write the same files concurrently are
  /// serialised by a lock on the folder of the file added first, so that all files are from one
  /// program; file systems without locks are not protected. Throws Error.
  void commit();
  /// Removes everything that is not committed.
  void clear() noexcept;

 private:
  struct NewFolder {
    std::filesystem::path path;
    int slot;  ///< of list_unfinished()
  };

  void unlist_folders() noexcept;

  std::vector<std::string> protected_;
  std::list<AtomicFile> files_;  // an AtomicFile does not move
  std::vector<NewFolder> folders_;
  std::vector<std::filesystem::path> removals_;
  bool is_locked_ = false;
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>

#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// Files that are renamed together when all of them are complete. Without commit() the
/// destructor removes them and the folders that were created for them.
class StagedFiles {
 public:
  StagedFiles() = default;
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;
  ~StagedFiles() { clear(); }

  /// Files that must not be overwritten; they must outlive this object.
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

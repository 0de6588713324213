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

/// Files that get their names together, once all of them are complete. Without commit() the
/// destructor removes them and the folders that were made for them.
class StagedFiles {
 public:
  StagedFiles() = default;
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;
  ~StagedFiles() { clear(); }

  /// Files that none of those that are added may replace; they must outlive this.
  void protect(std::span<const std::string> read) { protected_ = read; }
  /// A new file, to be written to and finished by the caller. Throws Error as AtomicFile does, and
  /// when it would replace a protected file.
  AtomicFile& add(const std::filesystem::path& path);
  /// The same for an open file of the system, which is sent the bytes.
  AtomicFile& add(int target, const std::filesystem::path& name) {
    return files_.emplace_back(target, name);
  }
  /// Removes a regular file at commit(), if it is there by then: one of an earlier output that does
  /// not belong to the new files.
  void remove(const std::filesystem::path& path) { removals_.push_back(path); }
  /// Makes a folder unless it is there. Throws Error.
  void add_folder(const std::filesystem::path& path);
  /// Removes what is outdated, then names the files, the one added first last: whoever waits for it
  /// finds the others too. Programs that write the same files at once take turns, by a lock on the
  /// folder of the file added first, so that all files in place are of one of them; file systems
  /// without locks do without. Throws Error.
  void commit();
  /// Removes everything that is not committed.
  void clear() noexcept;

 private:
  std::span<const std::string> protected_;
  std::list<AtomicFile> files_;  // an AtomicFile does not move
  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> removals_;
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace glidar {

/// Excludes other writers to a folder during its lifetime: an advisory lock (flock) on the folder
/// itself, so that no lock file is needed. The system releases it when the process ends.
class FolderLock {
 public:
  /// Waits for the lock, up to a minute. On file systems without such locks it is not acquired.
  /// Throws Error when another program keeps the lock for longer.
  explicit FolderLock(const std::filesystem::path& folder);

  /// The lock of a whole run, without waiting. Throws Error when another run or program has it.
  static FolderLock of_run(const std::filesystem::path& folder);

  /// Whether the file system granted the lock.
  [[nodiscard]] bool is_held() const { return static_cast<bool>(descriptor_); }

 private:
  FolderLock() = default;

  UniqueFd descriptor_;
};

struct ModelOptions;

/// The open folder of cached models. Entries are files named by 32 hexadecimal digits and
/// ".model"; all access goes through the descriptor.
struct CacheFolder {
  UniqueFd fd;                 ///< -1: the folder is not used
  std::filesystem::path path;  ///< for messages
  std::string problem;         ///< why it is not used, with the remedy; empty: it is used
};

/// ModelOptions::cache_folder, else $XDG_CACHE_HOME/glidar, else ~/.cache/glidar; none when there
/// is neither.
std::optional<std::filesystem::path> cache_folder_path(const ModelOptions& options);

/// Opens the folder, and creates it with access for its owner only (0700) if necessary.
/// A folder that belongs to another user, or that others may access, is not used.
CacheFolder open_cache_folder(const std::filesystem::path& path);

/// Maximum total size of all entries: $GLIDAR_CACHE_LIMIT_MIB, else 2 GiB.
/// Throws Error unless that is a whole number of MiB.
std::uint64_t cache_limit_bytes();

/// Opens an entry for reading; -1 when it is not there, not a regular file, belongs to another user
/// or can be written by others.
UniqueFd open_entry(const CacheFolder& folder, const std::string& name);

/// Marks an entry as used now: the least recently used entries are evicted first.
void touch_entry(const UniqueFd& entry);

/// Writes an entry under a temporary name and renames it, then evicts others until all entries
/// together are within the limit. Temporary files that dead processes left are removed.
/// Returns the reason why nothing was stored, or "".
std::string store_entry(const CacheFolder& folder, const std::string& name,
                        std::uint64_t limit_bytes, const std::function<void(int fd)>& write);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/files/unique_fd.hpp>

#include <filesystem>

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

}  // namespace glidar

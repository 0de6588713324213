// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/files/unique_fd.hpp>

#include <filesystem>

namespace glidar {

/// Excludes other writers to a folder while it lives: an advisory lock (flock) on the folder
/// itself, so that no file is left behind. It ends with the process at the latest.
class FolderLock {
 public:
  /// Waits for its turn, up to a minute. A file system that has no such locks gives none. Throws
  /// Error when another program keeps the lock for longer.
  explicit FolderLock(const std::filesystem::path& folder);

  /// Whether the file system gave the lock.
  [[nodiscard]] bool is_held() const { return static_cast<bool>(descriptor_); }

 private:
  UniqueFd descriptor_;
};

}  // namespace glidar

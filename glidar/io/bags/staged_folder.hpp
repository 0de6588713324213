// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <filesystem>
#include <string>
#include <vector>

namespace glidar::bags {

/// A folder that appears under its name only when all its files are complete. Until commit() they
/// are in a temporary folder beside it, which the destructor removes.
class StagedFolder {
 public:
  /// Throws Error when `path` exists and is not a folder that `is_replaceable` accepts, or no
  /// folder can be created beside it.
  StagedFolder(const std::filesystem::path& path,
               bool (*is_replaceable)(const std::filesystem::path&));
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// The path of a new file in the temporary folder, which a signal removes.
  std::filesystem::path add_file(const std::string& name);
  /// Gives the folder its name; a folder of this name is replaced and removed. Throws Error.
  void commit();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty once committed
  std::vector<int> slots_;           ///< of the list of unfinished files
};

}  // namespace glidar::bags

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/nearest_file.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <system_error>
#include <vector>

namespace glidar {

namespace fs = std::filesystem;

std::string nearest_file(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code error;  // an unreadable folder has no suggestions
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());  // the order of folder entries depends on the file system
  return closest_match(path.filename().string(), names);
}

}  // namespace glidar

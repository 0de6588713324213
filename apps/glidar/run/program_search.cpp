// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/program_search.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace glidar::app {

namespace fs = std::filesystem;

std::vector<fs::path> absolute_folders(std::string_view list) {
  std::vector<fs::path> folders;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(':'), list.size());
    const std::string_view entry = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    if (entry.starts_with('/')) folders.emplace_back(entry);
  }
  return folders;
}

std::string joined_folders(const std::vector<fs::path>& folders) {
  std::string list;
  for (const fs::path& folder : folders) list += (list.empty() ? "" : ":") + folder.string();
  return list;
}

std::vector<fs::path> program_folders() {
  const char* const list = std::getenv("PATH");
  return absolute_folders(list != nullptr ? list : "/usr/local/bin:/usr/bin:/bin");
}

std::vector<fs::path> find_programs(std::string_view name, const std::vector<fs::path>& folders) {
  std::vector<fs::path> programs;
  for (const fs::path& folder : folders) {
    fs::path program = folder / name;
    std::error_code error;
    if (!fs::is_regular_file(program, error) || ::access(program.c_str(), X_OK) != 0) continue;
    programs.push_back(std::move(program));
  }
  return programs;
}

}  // namespace glidar::app

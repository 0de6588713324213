// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/preset_names.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <algorithm>
#include <system_error>

namespace glidar {

namespace fs = std::filesystem;

std::string normalised_name(std::string_view name) {
  std::string normalised = lower_case(name);
  std::erase_if(normalised, [](char c) { return c == '-' || c == '_' || c == ' '; });
  return normalised;
}

std::string match_name(const std::string& name, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  const std::string wanted = normalised_name(name);
  const auto at = std::find_if(names.begin(), names.end(), [&](const std::string& candidate) {
    return normalised_name(candidate) == wanted;
  });
  return at == names.end() ? "" : *at;
}

std::string nearest_names(const std::string& name, std::vector<std::string> names,
                          const std::string& otherwise) {
  constexpr std::size_t kMaxNames = 3;
  std::vector<std::string> nearest;
  while (nearest.size() < kMaxNames) {
    const std::string next = closest_match(name, names);
    if (next.empty()) break;
    nearest.push_back(next);
    std::erase(names, next);
  }
  if (nearest.empty()) return otherwise;
  std::string text = "did you mean " + nearest.front();
  for (std::size_t i = 1; i < nearest.size(); ++i) {
    text += (i + 1 < nearest.size() ? ", " : " or ") + nearest[i];
  }
  return text + "?";
}

bool is_yaml(const fs::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return ending == ".yaml" || ending == ".yml";
}

std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_yaml(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // the order of a folder is not the same everywhere
  return files;
}

}  // namespace glidar

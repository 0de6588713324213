// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/overwrite_guard.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <system_error>

namespace glidar {

std::filesystem::path real_path(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path);
  std::error_code no_such_folder;
  const std::filesystem::path folder =
      std::filesystem::canonical(whole.parent_path(), no_such_folder);
  return no_such_folder ? whole.lexically_normal() : folder / whole.filename();
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code no_such_file;  // a missing file equals only its own name
  return real_path(a) == real_path(b) || std::filesystem::equivalent(a, b, no_such_file);
}

std::vector<std::string> files_of(const Scene& scene) {
  std::vector<std::string> files;
  for (const MeshSource& source : scene.sources) {
    files.insert(files.end(), source.files.begin(), source.files.end());
  }
  return files;
}

void refuse_overwrite_of_inputs(std::span<const std::string> read,
                                const std::filesystem::path& output) {
  std::error_code ignored;  // inaccessible files are compared by name
  const std::filesystem::path name = real_path(output);
  const bool is_there = std::filesystem::exists(output, ignored);
  const auto is_it = [&](const std::string& file) {
    return real_path(file) == name ||
           (is_there && std::filesystem::equivalent(file, output, ignored));
  };
  if (std::none_of(read.begin(), read.end(), is_it)) return;
  throw Error({.where = output.string(),
               .found = "is an input file, or another output writes it",
               .remedy = "choose another name"});
}

}  // namespace glidar

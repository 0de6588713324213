// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/import_program.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/paths.hpp>

#include <unistd.h>

#include <cstdlib>
#include <system_error>
#include <vector>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "glidar-import";
constexpr const char* kVariable = "GLIDAR_IMPORT_HELPER";

std::vector<fs::path> places() {
  std::vector<fs::path> all;
  std::error_code error;
  for (const fs::path& own : own_folders()) all.push_back(own / "libexec" / "glidar" / kName);
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) all.push_back(self.parent_path() / kName);
#ifdef GLIDAR_IMPORT_BUILD_PATH
  all.emplace_back(GLIDAR_IMPORT_BUILD_PATH);
#endif
  all.emplace_back(GLIDAR_IMPORT_INSTALL_PATH);
  return all;
}

bool runnable(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

fs::path import_program() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != '\0') {
    if (runnable(named)) return named;
    throw Error({.where = kVariable,
                 .found = std::string(named) + " is not an executable program",
                 .allowed = std::string("the path of ") + kName,
                 .remedy = "unset or correct it"});
  }
  std::string searched;
  for (const fs::path& place : places()) {
    if (runnable(place)) return place;
    searched += (searched.empty() ? "" : ", ") + place.string();
  }
  throw Error({.where = std::string("program ") + kName,
               .found = "not found in " + searched,
               .remedy = std::string("reinstall GLIDAR, or set ") + kVariable});
}

}  // namespace glidar

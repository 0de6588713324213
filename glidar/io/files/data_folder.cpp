// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/data_folder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/own_folders.hpp>

#include <cstdlib>
#include <vector>

namespace glidar {

namespace fs = std::filesystem;

fs::path data_folder(const std::string& name, const char* variable) {
  std::error_code error;
  if (const char* named = std::getenv(variable); named != nullptr && *named != '\0') {
    if (fs::is_directory(named, error)) return named;
    throw Error(
        {variable, std::string(named) + " is not a folder", "a folder like GLIDAR's " + name});
  }
  std::vector<fs::path> places;
  for (const fs::path& own : own_folders()) places.push_back(own / "share" / "glidar" / name);
#ifdef GLIDAR_DATA_SOURCE_PATH
  places.push_back(fs::path(GLIDAR_DATA_SOURCE_PATH) / name);
#endif
  places.push_back(fs::path(GLIDAR_DATA_INSTALL_PATH) / name);
  for (const fs::path& place : places) {
    if (fs::is_directory(place, error)) return place;
  }
  throw Error({"the " + name + " of GLIDAR", "not found in " + places.back().string(), "",
               std::string("reinstall GLIDAR, or set ") + variable});
}

}  // namespace glidar

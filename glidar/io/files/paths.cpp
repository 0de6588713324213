// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/paths.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <dlfcn.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <system_error>
#include <vector>

namespace glidar {

namespace fs = std::filesystem;

std::vector<fs::path> own_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  Dl_info info{};
  const auto* here = reinterpret_cast<const void*>(&own_folders);
  if (::dladdr(here, &info) != 0 && info.dli_fname != nullptr) {
    const fs::path holder = fs::canonical(info.dli_fname, error);
    if (!error && holder != program)
      return {holder.parent_path(), holder.parent_path().parent_path()};
  }
  return {program.parent_path().parent_path()};
}

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

namespace {

bool has_control_characters(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c < 0x20U || c == 0x7FU; });
}

[[noreturn]] void refuse(const std::string& where, std::string_view key, std::string_view text,
                         const char* allowed) {
  throw Error({where, std::string(key) + ": '" + excerpt(text) + "'", allowed, "write it again"});
}

}  // namespace

void check_recorded_path(const std::string& where, std::string_view key, std::string_view path) {
  constexpr std::size_t kMaxPath_bytes = 4096;
  if (!path.empty() && path.size() <= kMaxPath_bytes && !has_control_characters(path)) return;
  refuse(where, key, path, "a path of 1 to 4096 bytes without control characters");
}

void check_recorded_argument(const std::string& where, std::string_view argument) {
  constexpr std::size_t kMaxArgument_bytes = std::size_t{1} << 17U;  // Linux' own limit
  if (argument.size() <= kMaxArgument_bytes && !has_control_characters(argument)) return;
  refuse(where, "an argument of its command", argument,
         "at most 131072 bytes without control characters");
}

}  // namespace glidar

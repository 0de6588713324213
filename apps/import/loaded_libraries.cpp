// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/loaded_libraries.hpp>

#include <link.h>

#include <string_view>

namespace glidar::import {
namespace {

extern "C" int glidar_list_library(dl_phdr_info* info, std::size_t /*size*/, void* list) {
  const std::string_view path = info->dlpi_name;
  // Excludes the program itself, which has no name here, and the kernel's vDSO.
  if (path.starts_with('/')) static_cast<std::vector<std::string>*>(list)->emplace_back(path);
  return 0;
}

}  // namespace

std::vector<std::string> loaded_libraries() {
  std::vector<std::string> paths;
  ::dl_iterate_phdr(glidar_list_library, &paths);
  return paths;
}

}  // namespace glidar::import

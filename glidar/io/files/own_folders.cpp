// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/own_folders.hpp>

#include <dlfcn.h>

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

}  // namespace glidar

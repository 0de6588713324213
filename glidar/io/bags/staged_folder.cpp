// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/staged_folder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unfinished_files.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace glidar::bags {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_folder(const fs::path& path, const char* what, int code) {
  throw Error({path.string(),
               fmt::format("cannot {}: {}", what, std::generic_category().message(code)), "",
               code == ENOENT ? "create the folder above it first" : ""});
}

}  // namespace

StagedFolder::StagedFolder(const fs::path& path, bool (*is_replaceable)(const fs::path&))
    : path_(path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !(fs::is_directory(path, ignored) && is_replaceable(path))) {
    throw Error({path.string(), "exists and is no bag", "a new name, or a bag to replace",
                 "remove it, or write to another path"});
  }
  const fs::path folder = fs::absolute(path).parent_path();
  for (unsigned attempt = 0;; ++attempt) {
    fs::path name = folder / fmt::format(".glidar-{}-{}.folder.tmp", ::getpid(), attempt);
    const int slot = list_unfinished(name.native());
    constexpr mode_t kDefault = 0777;
    if (::mkdir(name.c_str(), kDefault) == 0) {
      slots_.push_back(slot);
      temporary_ = std::move(name);
      return;
    }
    const int code = errno;
    unlist_unfinished(slot);
    if (code != EEXIST) fail_folder(path, "create a folder here", code);
  }
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  for (const int slot : slots_) unlist_unfinished(slot);
}

fs::path StagedFolder::add_file(const std::string& name) {
  fs::path file = temporary_ / name;
  slots_.push_back(list_unfinished(file.native()));
  return file;
}

void StagedFolder::commit() {
  if (::rename(temporary_.c_str(), path_.c_str()) == 0) {
    temporary_.clear();
    return;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) fail_folder(path_, "rename", errno);
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0)
    fail_folder(path_, "replace the bag of this name", errno);
  // The temporary name is now that of the old bag, which the destructor removes.
}

}  // namespace glidar::bags

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/folder_lock.hpp>

#include <glidar/core/error.hpp>

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

namespace glidar {

namespace {

enum class Result { granted, taken, unavailable };

Result lock(const UniqueFd& descriptor) {
  while (::flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return Result::taken;
    if (errno != EINTR) return Result::unavailable;
  }
  return Result::granted;
}

UniqueFd open_folder(const std::filesystem::path& folder) {
  return UniqueFd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  constexpr std::chrono::minutes kMaxWait{1};
  constexpr std::chrono::microseconds kPause{200};  // other processes hold it for some renames only
  UniqueFd descriptor = open_folder(folder);
  if (!descriptor) return;  // a folder that is writable but not readable
  const auto end = std::chrono::steady_clock::now() + kMaxWait;
  for (Result result = lock(descriptor); result != Result::granted; result = lock(descriptor)) {
    if (result == Result::unavailable) return;
    if (std::chrono::steady_clock::now() > end) {
      throw Error({folder.string(), "another program has locked this folder for a minute", "",
                   "stop that program, or write to another folder"});
    }
    std::this_thread::sleep_for(kPause);
  }
  descriptor_ = std::move(descriptor);
}

FolderLock FolderLock::of_run(const std::filesystem::path& folder) {
  FolderLock held;
  UniqueFd descriptor = open_folder(folder);
  if (!descriptor) return held;
  const Result result = lock(descriptor);
  if (result == Result::taken) {
    throw Error({folder.string(), "another run writes to this folder now", "",
                 "wait until it has ended, or write to another folder"});
  }
  if (result == Result::granted) held.descriptor_ = std::move(descriptor);
  return held;
}

}  // namespace glidar

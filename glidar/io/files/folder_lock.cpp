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

FolderLock::FolderLock(const std::filesystem::path& folder) {
  constexpr std::chrono::minutes kMaxWait{1};
  constexpr std::chrono::microseconds kPause{200};  // other processes hold it for some renames only
  UniqueFd descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor) return;  // a folder that is writable but not readable
  const auto end = std::chrono::steady_clock::now() + kMaxWait;
  while (::flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return;
    if (std::chrono::steady_clock::now() > end) {
      throw Error({folder.string(), "another program has locked this folder for a minute", "",
                   "stop that program, or write to another folder"});
    }
    std::this_thread::sleep_for(kPause);
  }
  descriptor_ = std::move(descriptor);
}

}  // namespace glidar

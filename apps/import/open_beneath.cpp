// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/open_beneath.hpp>

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>

#include <cerrno>

namespace glidar::import {
namespace {

constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

int openat2(int folder, const char* path, std::uint64_t resolve) {
  open_how how{};
  how.flags = kFlags;
  how.resolve = resolve;
  return static_cast<int>(::syscall(SYS_openat2, folder, path, &how, sizeof how));
}

}  // namespace

UniqueFd open_root(const std::filesystem::path& root) {
  return UniqueFd(::open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
}

UniqueFd open_beneath(int root_fd, const std::filesystem::path& root,
                      const std::filesystem::path& path) {
  const std::filesystem::path below = path.lexically_relative(root);
  UniqueFd file(openat2(root_fd, below.c_str(), RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS));
  // The sandbox refuses openat2 with EPERM if it cannot distinguish reading from writing.
  const bool is_known = file || (errno != ENOSYS && errno != EPERM);
  return is_known ? std::move(file) : UniqueFd(::open(path.c_str(), kFlags | O_NOFOLLOW));
}

}  // namespace glidar::import

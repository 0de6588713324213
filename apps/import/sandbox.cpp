// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/sandbox.hpp>

#include <import/system_call_filter.hpp>

#include <unistd.h>

#include <climits>

namespace glidar::import {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

std::vector<std::string> enter_sandbox(const std::vector<std::filesystem::path>&, int last_fd,
                                       long) {
  ::close_range(static_cast<unsigned>(last_fd) + 1, UINT_MAX, 0);
  return {"the import process ran without its sandbox: GLIDAR was built with a sanitizer"};
}

#else

std::vector<std::string> enter_sandbox(const std::vector<std::filesystem::path>& readable,
                                       int last_fd, long newest_landlock) {
  std::vector<std::string> notes;
  // An old kernel without it: posix_spawn already closed them.
  ::close_range(static_cast<unsigned>(last_fd) + 1, UINT_MAX, 0);
  const FileRestriction landlock = restrict_files(readable, newest_landlock);
  if (!landlock.failure.empty()) {
    notes.push_back(
        "the import process ran without Landlock, which confines it to the model's folders (" +
        landlock.failure + ")");
  }
  // The filter does not see the flags of openat2, which truncates a file that it opens for reading.
  const std::string no_filter =
      filter_system_calls(landlock.covers_truncation ? Openat2::allowed : Openat2::refused);
  if (!no_filter.empty()) {
    notes.push_back("the import process ran without its filter of system calls, seccomp (" +
                    no_filter + ")");
  }
  return notes;
}

#endif

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/file_sync.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace glidar {
namespace {

/// 0 or an error number. Not repeated after an error other than EINTR: Linux reports a lost write
/// once, so that the next call would succeed without the data.
int sync(int descriptor) {
  while (::fsync(descriptor) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code,
                       const char* remedy) {
  const bool is_full = code == ENOSPC || code == EDQUOT;
  throw Error({path.string(),
               fmt::format("cannot {}: {}", what, std::generic_category().message(code)), "",
               is_full ? "make room or write to another folder" : remedy});
}

}  // namespace

void sync_file(int descriptor, const std::filesystem::path& path) {
  const int error = sync(descriptor);
  if (error != 0) {
    fail(path, "write to the disk (fsync)", error, "check the disk; no part of this file remains");
  }
}

void sync_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const UniqueFd descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const int error = descriptor ? sync(descriptor.get()) : errno;
  // POSIX lets a file system reject it (EINVAL); FUSE and network file systems do (ENOTSUP).
  if (error == 0 || (descriptor && (error == EINVAL || error == ENOTSUP))) return;
  fail(path, "write its folder to the disk (fsync)", error,
       "the file is in place and complete, but may not survive power loss; check the disk, or "
       "omit --durable");
}

}  // namespace glidar

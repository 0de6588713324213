// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/input_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/files/nearest_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string found, std::string allowed = "",
                       std::string remedy = "") {
  throw Error({path.string(), std::move(found), std::move(allowed), std::move(remedy)});
}

[[noreturn]] void fail_to_open(const fs::path& path, int code, const InputFileKind& kind) {
  if (code == ENOENT || code == ENOTDIR) {
    const std::string nearest = nearest_file(path);
    fail(path, "no such file", "",
         nearest.empty() ? "" : "did you mean '" + excerpt(nearest) + "'?");
  }
  if (code == ENXIO || code == ENODEV) fail(path, "not a regular file", kind.name);
  fail(path, "cannot be opened: " + std::generic_category().message(code), "a readable file");
}

void check_size(const fs::path& path, std::uintmax_t size, const InputFileKind& kind) {
  if (size <= kind.max_mib << 20U) return;
  const std::string limit = std::to_string(kind.max_mib) + " MiB";
  fail(path, "a file of more than " + limit, kind.name + " of at most " + limit,
       kind.remedy_if_larger);
}

}  // namespace

InputFile open_input_file(const fs::path& path, const InputFileKind& kind) {
  if (path.native().find('\0') != std::string::npos)
    fail(excerpt(path.native()), "a zero byte in the file name", "a path");
  // O_NONBLOCK: opening a pipe without a writer would block
  InputFile file{UniqueFd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY))};
  if (!file.descriptor) fail_to_open(path, errno, kind);
  struct stat info {};
  if (::fstat(file.descriptor.get(), &info) != 0) fail_to_open(path, errno, kind);
  if (S_ISDIR(info.st_mode)) fail(path, "a folder", kind.name);
  if (!S_ISREG(info.st_mode)) fail(path, "not a regular file", kind.name);
  file.size = static_cast<std::size_t>(info.st_size);
  check_size(path, file.size, kind);
  return file;
}

std::size_t read_some(const InputFile& file, const fs::path& path, char* to, std::size_t size) {
  for (;;) {
    const ssize_t count = ::read(file.descriptor.get(), to, size);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EINTR) continue;
    fail(path, "cannot be read: " + std::generic_category().message(errno));
  }
}

std::string read_input_file(const fs::path& path, const InputFileKind& kind) {
  const InputFile file = open_input_file(path, kind);
  std::string content(file.size + 1, '\0');  // one more byte, to detect the end of the file
  std::size_t filled = 0;
  for (;;) {
    const std::size_t count =
        read_some(file, path, content.data() + filled, content.size() - filled);
    filled += count;
    if (count == 0) break;
    check_size(path, filled, kind);
    if (filled == content.size()) content.resize(2 * content.size());
  }
  content.resize(filled);
  return content;
}

}  // namespace glidar

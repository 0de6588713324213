// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/read_whole.hpp>

#include <glidar/core/error.hpp>

#include <fstream>

namespace glidar {

std::string read_whole(const std::filesystem::path& path, std::uintmax_t most) {
  const auto fail = [&](std::string found, std::string allowed) {
    throw Error({path.string(), std::move(found), std::move(allowed), ""});
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("no such file", "");
  if (!std::filesystem::is_regular_file(status)) fail("not a regular file", "a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > most) {
    fail("a file of " + std::to_string(size) + " bytes", "at most " + std::to_string(most));
  }
  std::string bytes(size, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) fail("cannot be read", "a file you may read");
  return bytes;
}

}  // namespace glidar

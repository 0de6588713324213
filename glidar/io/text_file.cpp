// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/text_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/nearest_file.hpp>

#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace glidar {
namespace fs = std::filesystem;

std::string shown(std::string_view word) {
  constexpr std::size_t kShown = 60;
  std::string out(word.substr(0, kShown));
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) c = '?';
  }
  return word.size() > kShown ? out + "..." : out;
}

std::string read_binary_file(const fs::path& file, const TextFileKind& kind) {
  const auto fail = [&](std::string found, std::string allowed, std::string remedy) {
    throw Error({file.string(), std::move(found), std::move(allowed), std::move(remedy)});
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    const std::string nearest = nearest_file(file);
    fail("no such file", "", nearest.empty() ? "" : "did you mean '" + nearest + "'?");
  }
  if (fs::is_directory(status)) fail("a folder", kind.name, "");
  if (!fs::is_regular_file(status)) fail("not a regular file", kind.name, "");
  if (fs::file_size(file, error) > kind.largest_mib << 20U) {
    const std::string limit = std::to_string(kind.largest_mib) + " MiB";
    fail("a file of more than " + limit, kind.name + " of at most " + limit, kind.remedy_if_larger);
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  std::string content = std::move(bytes).str();
  if (!stream.is_open()) fail("cannot be opened", "a file you may read", "");
  return content;
}

std::string read_text_file(const fs::path& file, const TextFileKind& kind) {
  std::string content = read_binary_file(file, kind);
  if (content.find('\0') != std::string::npos) {
    throw Error({file.string(), "binary data", kind.name, ""});
  }
  return content;
}

}  // namespace glidar

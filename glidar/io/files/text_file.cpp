// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/text_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/core/text.hpp>

#include <algorithm>

namespace glidar {

namespace fs = std::filesystem;

std::string shown(std::string_view word) {
  constexpr std::size_t kShown = 63;
  return excerpt(word, kShown);
}

std::string read_text_file(const fs::path& file, const TextFileKind& kind) {
  std::string content = read_input_file(file, kind);
  if (content.find('\0') != std::string::npos) {
    throw Error({file.string(), "binary data", kind.name});
  }
  return content;
}

void require_utf8(const fs::path& file, std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = utf8_size(text.substr(at));
    if (size == 0) {
      const auto line =
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw Error({file.string() + ":" + std::to_string(line + 1), "bytes that are not UTF-8",
                   "text in UTF-8", "convert it, for example with iconv"});
    }
    at += size;
  }
}

}  // namespace glidar

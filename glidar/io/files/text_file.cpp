// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/text_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>

#include <algorithm>

namespace glidar {
namespace {

namespace fs = std::filesystem;

/// Length in bytes of the UTF-8 character at the start of a text (RFC 3629); 0: invalid.
std::size_t character_size(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t size = first >= 0xF0U ? 4 : (first >= 0xE0U ? 3 : 2);
  if (first < 0xC2U || first > 0xF4U) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  // overlong encoding, surrogate, or beyond the last code point
  const bool is_long = (first == 0xE0U && byte(1) < 0xA0U) || (first == 0xF0U && byte(1) < 0x90U);
  const bool is_no_letter =
      (first == 0xEDU && byte(1) > 0x9FU) || (first == 0xF4U && byte(1) > 0x8FU);
  return is_long || is_no_letter ? 0 : size;
}

}  // namespace

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
    const std::size_t size = character_size(text.substr(at));
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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/excerpt.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>

namespace glidar {
namespace {

/// True for the second and later bytes of a UTF-8 character.
bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Bytes of the printable UTF-8 character at the start of the text; 0: there is none. U+0080 to
/// U+009F control terminals too.
std::size_t printable_size(std::string_view text) {
  const std::size_t size = utf8_size(text);
  const auto byte_at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (size == 1 && (byte_at(0) < 0x20U || byte_at(0) == 0x7FU)) return 0;
  if (size == 2 && byte_at(0) == 0xC2U && byte_at(1) < 0xA0U) return 0;
  return size;
}

}  // namespace

std::string excerpt(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view kCut = "...";
  const bool is_cut = text.size() > max_bytes;
  std::size_t size = is_cut ? max_bytes - std::min(max_bytes, kCut.size()) : text.size();
  while (is_cut && size > 0 && continues_character(text[size])) --size;
  std::string line;
  for (std::string_view rest = text.substr(0, size); !rest.empty();) {
    const std::size_t printable = printable_size(rest);
    line += printable == 0 ? "?" : rest.substr(0, printable);
    rest.remove_prefix(std::max<std::size_t>(printable, 1));
  }
  return is_cut ? line.append(kCut) : line;
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/excerpt.hpp>

#include <algorithm>

namespace glidar {
namespace {

/// True for the second and later bytes of a UTF-8 character.
bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

}  // namespace

std::string excerpt(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view kCut = "...";
  const bool is_cut = text.size() > max_bytes;
  std::size_t size = is_cut ? max_bytes - std::min(max_bytes, kCut.size()) : text.size();
  while (is_cut && size > 0 && continues_character(text[size])) --size;
  std::string line(text.substr(0, size));
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20U || c == 0x7FU; }, '?');
  return is_cut ? line.append(kCut) : line;
}

}  // namespace glidar

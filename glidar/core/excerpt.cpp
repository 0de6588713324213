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

/// Smallest and largest second byte of a character, by its first (RFC 3629, section 4). Those of
/// C2 leave out U+0080 to U+009F, which control terminals.
struct SecondBytes {
  unsigned char min = 0x80;
  unsigned char max = 0xBF;
};

SecondBytes second_bytes(unsigned char first) {
  switch (first) {
    case 0xC2:
    case 0xE0:
      return {.min = 0xA0};
    case 0xED:
      return {.max = 0x9F};
    case 0xF0:
      return {.min = 0x90};
    case 0xF4:
      return {.max = 0x8F};
    default:
      return {};
  }
}

/// Bytes of the printable UTF-8 character at the start of the text; 0: there is none.
std::size_t printable_size(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x80U) return first < 0x20U || first == 0x7FU ? 0 : 1;
  if (first < 0xC2U || first > 0xF4U) return 0;
  const std::size_t size = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  const std::string_view rest = text.substr(1, size - 1);
  if (rest.size() + 1 < size || !std::all_of(rest.begin(), rest.end(), continues_character))
    return 0;
  const auto second = static_cast<unsigned char>(rest.front());
  const SecondBytes allowed = second_bytes(first);
  return second < allowed.min || second > allowed.max ? 0 : size;
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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace glidar {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

std::string comma_separated(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string_view trimmed(std::string_view text, std::string_view characters) {
  const std::size_t first = text.find_first_not_of(characters);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(characters) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::size_t utf8_size(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return text.empty() ? 0 : 1;
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

namespace {

/// True for the second and later bytes of a UTF-8 character.
bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

struct CodePointRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Characters that terminals obey, that change the order of their neighbours (Unicode UAX #9), that
/// end lines, or that nobody sees.
constexpr std::array kNotShown = {
    CodePointRange{0x00, 0x1F},        // C0: ESC begins a control sequence
    CodePointRange{0x7F, 0x9F},        // DEL and C1: U+009B begins one too
    CodePointRange{0xAD, 0xAD},        // soft hyphen
    CodePointRange{0x61C, 0x61C},      // Arabic letter mark
    CodePointRange{0x180E, 0x180E},    // Mongolian vowel separator
    CodePointRange{0x200B, 0x200F},    // zero width, and direction marks
    CodePointRange{0x2028, 0x202E},    // separators of lines; embeddings and overrides
    CodePointRange{0x2060, 0x206F},    // invisible operators; isolates
    CodePointRange{0xFEFF, 0xFEFF},    // byte order mark
    CodePointRange{0xFFF9, 0xFFFB},    // annotations
    CodePointRange{0xE0000, 0xE007F},  // tags
};

/// The code point of a valid UTF-8 character of `size` bytes.
std::uint32_t code_point(std::string_view text, std::size_t size) {
  constexpr std::array<unsigned, 5> kFirstBits = {0, 0x7FU, 0x1FU, 0x0FU, 0x07U};
  std::uint32_t value = static_cast<unsigned char>(text[0]) & kFirstBits.at(size);
  for (std::size_t i = 1; i < size; ++i)
    value = (value << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
  return value;
}

/// Bytes of the printable UTF-8 character at the start of the text; 0: there is none.
std::size_t printable_size(std::string_view text) {
  const std::size_t size = utf8_size(text);
  if (size == 0) return 0;
  const std::uint32_t value = code_point(text, size);
  const bool is_hidden = std::any_of(
      kNotShown.begin(), kNotShown.end(),
      [&](const CodePointRange& range) { return value >= range.first && value <= range.last; });
  return is_hidden ? 0 : size;
}

/// The text with '?' for what is not printable; the characters in `kept` remain.
std::string printable(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const bool is_kept = kept.find(text.front()) != std::string_view::npos;
    const std::size_t size = is_kept ? 1 : printable_size(text);
    result += size == 0 ? "?" : text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return result;
}

}  // namespace

std::string printable_line(std::string_view text) {
  return printable(text, "");
}

std::string printable_lines(std::string_view text) {
  return printable(text, "\n\t");
}

std::string excerpt(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view kCut = "...";
  const bool is_cut = text.size() > max_bytes;
  std::size_t size = is_cut ? max_bytes - std::min(max_bytes, kCut.size()) : text.size();
  while (is_cut && size > 0 && continues_character(text[size])) --size;
  std::string line = printable_line(text.substr(0, size));
  return is_cut ? line.append(kCut) : line;
}

std::string decimal_text(double value, unsigned decimals) {
  std::uint64_t scale = 1;
  for (unsigned i = 0; i < decimals; ++i) scale *= 10;
  const double scaled = std::floor(std::abs(value) * static_cast<double>(scale) + 0.5);
  constexpr double kMaxWhole = 1e18;
  if (!(scaled < kMaxWhole)) return "none";
  const auto whole = static_cast<std::uint64_t>(scaled);
  std::string text = value < 0.0 && whole > 0 ? "-" : "";
  text += std::to_string(whole / scale);
  if (decimals == 0) return text;
  const std::string fraction = std::to_string(whole % scale);
  return text + '.' + std::string(decimals - fraction.size(), '0') + fraction;
}

}  // namespace glidar

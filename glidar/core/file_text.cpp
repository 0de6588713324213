// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/file_text.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace glidar {
namespace {

constexpr std::string_view kNoName = "field";

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Bytes of the white space at the start of a printable text; 0: there is none (Unicode, property
/// White_Space).
std::size_t white_space_size(std::string_view text) {
  constexpr std::array<std::string_view, 6> kOthers = {" ",      "\u00A0", "\u1680",
                                                       "\u202F", "\u205F", "\u3000"};
  for (const std::string_view space : kOthers)
    if (text.starts_with(space)) return space.size();
  constexpr std::string_view kFirst = "\u2000";
  constexpr std::string_view kLast = "\u200A";
  const std::string_view start = text.substr(0, kFirst.size());
  return start >= kFirst && start <= kLast ? kFirst.size() : 0;
}

}  // namespace

std::string FileText::column_name() const {
  constexpr std::size_t kMaxName_bytes = 64;  // leaves room for numbers
  std::string name;
  bool was_replaced = false;
  for (const char c : bytes_) {
    const bool is_kept = is_name_character(c);
    if (is_kept || !was_replaced) name += is_kept ? c : '_';
    was_replaced = !is_kept;
    if (name.size() == kMaxName_bytes) break;
  }
  return name.empty() ? std::string(kNoName) : name;
}

std::string FileText::word() const {
  const std::string line = printable_line(bytes_);
  std::string word;
  for (std::string_view rest = line; !rest.empty();) {
    const std::size_t space = white_space_size(rest);
    const std::size_t size = space == 0 ? std::max<std::size_t>(utf8_size(rest), 1) : space;
    word += space == 0 ? rest.substr(0, size) : "_";
    rest.remove_prefix(size);
  }
  return word.empty() ? "_" : word;
}

bool is_column_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxColumnName_bytes &&
         std::all_of(text.begin(), text.end(), is_name_character);
}

}  // namespace glidar

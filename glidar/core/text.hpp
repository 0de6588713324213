// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The text with ASCII capitals as small letters.
std::string lower_case(std::string_view text);

/// The words with ", " between.
std::string comma_separated(std::span<const std::string> words);

inline constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";

/// The text without these characters at both ends.
std::string_view trimmed(std::string_view text, std::string_view characters = kWhiteSpace);

/// The parts between separators: one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// Size in bytes of the UTF-8 character at the start of the text (RFC 3629); 0: none or invalid.
std::size_t utf8_size(std::string_view text);

}  // namespace glidar

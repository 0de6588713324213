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

inline constexpr std::size_t kMaxExcerpt_bytes = 200;

/// The text as people may see it, in one line of UTF-8: '?' replaces control characters (also line
/// ends and tabs), characters that change the order of others or are invisible, and each byte that
/// is not UTF-8. Everything that reaches a terminal passes through this or printable_lines().
std::string printable_line(std::string_view text);

/// The same for texts of several lines: line ends and tabs remain.
std::string printable_lines(std::string_view text);

/// A printable line of at most `max_bytes`. A longer text is cut between characters, with "...".
std::string excerpt(std::string_view text, std::size_t max_bytes = kMaxExcerpt_bytes);

/// A number with this many decimals, at most 9, independent of the locale; "none" for NaN and
/// infinities. For reports; number_text() keeps all digits.
std::string decimal_text(double value, unsigned decimals = 2);

}  // namespace glidar

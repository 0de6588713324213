// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar {

inline constexpr std::size_t kMaxExcerpt_bytes = 200;

/// The text as people may see it, in one line of UTF-8: '?' replaces control characters (also line
/// ends and tabs), characters that change the order of others or are invisible, and each byte that
/// is not UTF-8. Everything that reaches a terminal passes through this or printable_lines().
std::string printable_line(std::string_view text);

/// The same for texts of several lines: line ends and tabs remain.
std::string printable_lines(std::string_view text);

/// A printable line of at most `max_bytes`. A longer text is cut between characters, with "...".
std::string excerpt(std::string_view text, std::size_t max_bytes = kMaxExcerpt_bytes);

}  // namespace glidar

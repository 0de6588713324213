// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar {

inline constexpr std::size_t kMaxExcerpt_bytes = 200;

/// What an error quotes of a file, a message or an option: one line of at most `max_bytes`, without
/// control characters. A longer text is cut between two characters and ends with "...".
std::string excerpt(std::string_view text, std::size_t max_bytes = kMaxExcerpt_bytes);

}  // namespace glidar

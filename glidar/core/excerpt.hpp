// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar {

inline constexpr std::size_t kMaxExcerpt_bytes = 200;

/// The text as error messages quote it: one line of at most `max_bytes`, UTF-8, with '?' for
/// control characters and invalid bytes. A longer text is cut between characters, with "...".
std::string excerpt(std::string_view text, std::size_t max_bytes = kMaxExcerpt_bytes);

}  // namespace glidar

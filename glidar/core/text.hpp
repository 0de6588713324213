// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace glidar {

/// The text with ASCII capitals as small letters.
std::string lower_case(std::string_view text);

/// The words with ", " between.
std::string comma_separated(std::span<const std::string> words);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Times as texts, without a detour through double, whose steps at times since 1970 are 238 ns.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glidar {

/// Decimal seconds as nanoseconds, rounded at the tenth decimal: "12.5" and "1.25e1" are
/// 12500000000. Empty for other texts and beyond 9.2e9 s, 290 years.
std::optional<std::int64_t> parse_seconds_ns(std::string_view text);

/// A date of ISO 8601 in UTC, such as 2026-01-31T12:00:00.5Z, as nanoseconds since 1970. Empty for
/// other texts.
std::optional<std::int64_t> parse_date_ns(std::string_view text);

/// Seconds with all decimals that are not 0: "12.5".
std::string decimal_seconds(std::int64_t t_ns);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/echo.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The names of returns: "first", "second", "last", "strongest", ...
std::span<const char* const> known_return_names();
std::vector<std::string> return_names();

/// The return of one of these names.
Return return_named(std::string_view name);

/// The `count` nearest returns.
std::vector<Return> nearest_returns(std::uint32_t count);

/// Whether these are the nearest returns, in order.
bool are_nearest(const std::vector<Return>& returns);

/// The word for a return, or "return 4" and so on of the nearest.
std::string return_name(const Return& one);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace glidar::app {

/// The value rounded to so many decimals, half away from zero; never -0. Not finite: unchanged.
double rounded(double value, int decimals);

/// The text with every number that is zero written without a minus sign: "-0.00" becomes "0.00".
/// All numbers of the window pass through this or rounded().
std::string without_negative_zeros(std::string_view text);

}  // namespace glidar::app

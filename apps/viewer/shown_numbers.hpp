// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::app {

/// Rounds to so many decimals, half away from zero; never returns -0. Keeps non-finite values.
double rounded(double value, int decimals);

/// Removes the minus sign of every zero number: "-0.00" becomes "0.00". All numbers in the window
/// use this or rounded().
std::string without_negative_zeros(const std::string& text);

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar {

/// A number with this many decimals, at most 9, independent of the locale; "none" for NaN and
/// infinities. For reports; number_text() keeps all digits.
std::string decimal_text(double value, unsigned decimals = 2);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <optional>

namespace glidar {

/// The number n in a file's unit for which n * unit is `inside`, bit for bit: the number with few
/// digits (in_unit), the quotient, or one of the few numbers beside it. None where
/// multiplication skips `inside`, as it does for about one number in ten of those that were not
/// read from a file.
std::optional<double> find_exact_in(double inside, double unit);

/// The same; throws Error where there is none.
double exact_in(double inside, double unit);

}  // namespace glidar

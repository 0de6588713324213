// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

namespace glidar {

/// A number in a file's unit; `unit` is the size of that unit in ours, by which readers multiply.
/// value / unit carries the errors of two roundings (903 nm would be 903.0000000000001 nm).
/// Rounded to 15 significant digits it is the decimal number that was read, if that had no more
/// digits: the errors, at most 3.4e-16 of the value, are below half a unit of the 15th digit, at
/// least 5e-16. The rounded number is taken only when it converts back to exactly `value`.
double in_unit(double value, double unit);

/// The number n in a file's unit for which n * unit is `inside`, bit for bit: the number with few
/// digits (in_unit), the quotient, or one of the few numbers beside it. None where
/// multiplication skips `inside`, as it does for about one number in ten of those that were not
/// read from a file.
std::optional<double> find_exact_in(double inside, double unit);

/// The same; throws Error where there is none.
double exact_in(double inside, double unit);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how numbers are written into JSON files.

#include <nlohmann/json.hpp>

namespace glidar {

/// A number in a file's unit; `unit` is the size of that unit in ours, by which readers multiply.
/// value / unit carries the errors of two roundings (903 nm would be 903.0000000000001 nm).
/// Rounded to 15 significant digits it is the decimal number that was read, if that had no more
/// digits: the errors, at most 3.4e-16 of the value, are below half a unit of the 15th digit, at
/// least 5e-16. The rounded number is taken only when it converts back to exactly `value`.
double in_unit(double value, double unit);

/// How a number in the library's units becomes one of a file's unit, as in_unit does.
using InUnit = double (*)(double inside, double unit);

/// Writes 0.0 for every -0.0 in the document.
void remove_negative_zeros(nlohmann::ordered_json& json);

}  // namespace glidar

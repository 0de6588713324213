// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace glidar {

/// A function by its values at rising places: pairs (place, value), straight between them and
/// constant outside.
using LookupTable = std::vector<std::array<double, 2>>;

/// The table's value at x; `if_empty` for an empty table.
double interpolate(const LookupTable& table, double x, double if_empty = 0.0);

}  // namespace glidar

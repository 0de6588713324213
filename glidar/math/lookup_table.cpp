// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/lookup_table.hpp>

#include <algorithm>

namespace glidar {

double interpolate(const LookupTable& table, double x, double if_empty) {
  if (table.empty()) return if_empty;
  const auto is_before = [](double key, const LookupTable::value_type& pair) {
    return key < pair[0];
  };
  const auto above = std::upper_bound(table.begin(), table.end(), x, is_before);
  if (above == table.begin()) return table.front()[1];
  if (above == table.end()) return table.back()[1];
  const auto& [x0, y0] = *(above - 1);
  const auto& [x1, y1] = *above;
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

}  // namespace glidar

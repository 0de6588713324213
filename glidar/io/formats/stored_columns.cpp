// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/stored_columns.hpp>

#include <glidar/math/single_precision.hpp>

#include <fmt/format.h>

#include <cmath>

namespace glidar {
namespace {

/// The maximum change of a number of this column by rounding to float.
double rounding(const Column& column) {
  double farthest = 0.0;
  for (const double value : std::get<std::vector<double>>(column.values)) {
    const double moved = std::abs(value - rounded_to_float(value));
    if (moved > farthest) farthest = moved;  // false for misses, which are NaN
  }
  return farthest;
}

}  // namespace

std::vector<StoredColumn> stored_columns(std::span<const PointField> fields) {
  std::vector<StoredColumn> columns;
  for (const PointField& field : fields) {
    const bool same = !columns.empty() && columns.back().column == field.column &&
                      columns.back().stored == field.stored;
    if (!same) columns.push_back({field.column, field.stored, {}});
    columns.back().fields.push_back(field.name);
  }
  return columns;
}

std::string rounding_warning(std::span<const PointField> fields, std::string_view remedy) {
  std::string moves;
  for (const StoredColumn& stored : stored_columns(fields)) {
    const Column& column = *stored.column;
    if (stored.stored != Stored::f32 || float_is_enough(column)) continue;
    const double moved_m = rounding(column);
    if (!(moved_m > kFinePosition_m)) continue;
    moves += fmt::format("{}its {} by up to {:.2g} m", moves.empty() ? "" : ", ",
                         column.name == "xyz" ? "points" : column.name, moved_m);
  }
  if (moves.empty()) return moves;
  return fmt::format("rounding to float32 moves {}; {}", moves, remedy);
}

}  // namespace glidar

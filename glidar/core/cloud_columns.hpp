// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/core: the columns of clouds.

#include <glidar/core/column_fill.hpp>

#include <span>
#include <string>
#include <vector>

namespace glidar {

/// A known column: its fields, the hit columns that it requires, and the function that fills it.
struct ColumnKind {
  std::string name;
  std::vector<std::string> components;
  HitColumnMask needs;
  void (*fill)(const ColumnSource&, Column&);
};

/// All columns, in the order in which files list them.
std::span<const ColumnKind> column_kinds();

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/point_rows.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// A column of a file: fields that are adjacent in one column of the cloud and have the same
/// stored type.
struct StoredColumn {
  const Column* column = nullptr;
  Stored stored = Stored::f32;
  std::vector<std::string> fields;  ///< names in the file
};

std::vector<StoredColumn> stored_columns(std::span<const PointField> fields);

/// The warning for doubles that are stored as float, when that moves a coordinate or depth by more
/// than kFinePosition_m: the distance and the remedy. Empty otherwise.
std::string rounding_warning(std::span<const PointField> fields, std::string_view remedy);

}  // namespace glidar

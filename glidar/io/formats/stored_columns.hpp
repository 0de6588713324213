// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/point_rows.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// A column as a file holds it: fields that are neighbours in one column of the cloud and are
/// stored alike.
struct StoredColumn {
  const Column* column = nullptr;
  Stored stored = Stored::f32;
  std::vector<std::string> fields;  ///< names in the file
};

std::vector<StoredColumn> stored_columns(std::span<const Field> fields);

/// "f32", "f64", "u8", "u16", "u32", "i64", "packed_rgb".
std::string_view type_name(Stored stored);

/// What to tell of doubles stored as float where that moves a coordinate or depth by more than
/// kFinePosition_m: how far, and the remedy. Empty when there is nothing to tell.
std::string rounding_told(std::span<const Field> fields, std::string_view remedy);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The type of a field in a file, little-endian.
enum class Stored : std::uint8_t {
  f32,
  f64,
  u8,
  u16,
  u32,
  i64,
  colour_byte,  ///< u8, 0..1 times 255
  packed_rgb,   ///< u32 0x00RRGGBB made from three components
  whole_s,      ///< u32, the seconds of nanoseconds
  rest_ns,      ///< u32, the nanoseconds after them
};

/// One number per point: a component of a column.
struct PointField {
  std::string name;
  const Column* column = nullptr;
  std::size_t component = 0;
  Stored stored = Stored::f32;
};

/// How files describe a stored type.
struct StoredType {
  std::size_t bytes;
  std::string_view name;  ///< in a sidecar
  std::string_view ply_name;
};

const StoredType& type_of(Stored stored);

/// The type of a column in memory.
Stored native_type(const Column& column);

/// True for RGB as three floats.
bool is_colour(const Column& column);

/// Appends a field per component, with the column's own names and type.
void append_fields(const Column& column, std::vector<PointField>& fields);

/// The same as PCL's point types have it, with colour packed into `rgb`; returns the new fields.
std::span<PointField> append_pcl_fields(const Column& column, std::vector<PointField>& fields);

/// Appends the seconds and nanoseconds of times in nanoseconds, for formats without 64-bit
/// integers: `stamp_sec` and `stamp_nsec` of `stamp`. A double has steps of 256 ns at times since
/// 1970.
void append_split_time(const Column& column, std::vector<PointField>& fields);

/// A field per component of every column, with their own names and types.
std::vector<PointField> native_fields(const PointCloud& cloud);

/// Maximum displacement of a point by rounding that causes no warning.
inline constexpr double kFinePosition_m = 1e-4;

/// False when rounding to float can move a number of this column by more than kFinePosition_m;
/// columns of other types than double never need more.
bool float_is_enough(const Column& column);

/// Size of one point with these fields, in bytes.
std::size_t row_bytes(std::span<const PointField> fields);

/// Points first .. first + count - 1, each as row_bytes(fields) bytes, into `rows`.
void pack_rows(std::span<const PointField> fields, std::size_t first, std::size_t count,
               std::span<std::byte> rows);

/// `count` points, point by point, to the file; reports to `progress`.
void write_binary_rows(std::span<const PointField> fields, std::size_t count, AtomicFile& file,
                       const ProgressCallback& progress = {});

/// `count` points as text, a line each: the shortest digits that represent each number exactly;
/// "nan".
void write_text_rows(std::span<const PointField> fields, std::size_t count, char separator,
                     AtomicFile& file, const ProgressCallback& progress = {});

/// The fields' names, joined by `separator`.
std::string joined_names(std::span<const PointField> fields, char separator);

}  // namespace glidar

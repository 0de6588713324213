// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/point_rows.hpp>

#include <glidar/math/simd.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <type_traits>

namespace glidar {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written in memory order");

/// Small enough that a block of source and target stays in the first-level cache while each field
/// is copied.
constexpr std::size_t kBlockRows = 512;
constexpr std::size_t kTextChunkRows = 4096;

/// Target positions: every `stride` bytes from `first`, `count` times.
struct Places {
  std::byte* first;
  std::size_t stride;
  std::size_t count;
};

/// The inner loop of all writers: `from` advances by `step` numbers per point, of which the first
/// kCount are stored contiguously.
template <class To, std::size_t kCount, class From, class Convert>
void store_each(const From* from, std::size_t step, const Places& to, Convert convert) {
  std::byte* place = to.first;
  for (std::size_t i = 0; i < to.count; ++i, from += step, place += to.stride) {
    // One by one: a copy of the array as a whole would wait for the stores of its numbers.
    for (std::size_t c = 0; c < kCount; ++c) {
      const To value = convert(from + c);
      std::memcpy(place + c * sizeof(To), &value, sizeof(To));
    }
  }
}

/// Three at a time, because most columns have three components.
template <class To, class From, class Convert>
void store_run(const From* from, std::size_t step, std::size_t run, Places to, Convert convert) {
  while (run > 0) {
    const std::size_t now = run >= 3 ? 3 : 1;
    if (now == 3) {
      store_each<To, 3>(from, step, to, convert);
    } else {
      store_each<To, 1>(from, step, to, convert);
    }
    from += now;
    run -= now;
    to.first += now * sizeof(To);
  }
}

template <class To, class From>
void store_cast(const From* from, std::size_t step, std::size_t run, const Places& to) {
  store_run<To>(from, step, run, to, [](const From* value) { return static_cast<To>(*value); });
}

/// NaN gives 0.
std::uint8_t colour_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::min(std::max(0.0F, value), 1.0F)));
}

std::uint32_t packed_rgb(const float* rgb) {
  return (std::uint32_t{colour_byte(rgb[0])} << 16U) | (std::uint32_t{colour_byte(rgb[1])} << 8U) |
         std::uint32_t{colour_byte(rgb[2])};
}

constexpr std::int64_t kSecondInNs = 1'000'000'000;

/// Seconds before 1970 give 0.
std::uint32_t stored_seconds(std::int64_t t_ns) {
  return static_cast<std::uint32_t>(std::max<std::int64_t>(0, t_ns) / kSecondInNs);
}

std::uint32_t stored_nanoseconds(std::int64_t t_ns) {
  return static_cast<std::uint32_t>(std::max<std::int64_t>(0, t_ns) % kSecondInNs);
}

template <class From>
void store_fields(const From* from, std::size_t step, std::span<const PointField> same,
                  const Places& to) {
  const std::size_t run = same.size();
  switch (same.front().stored) {
    case Stored::f32:
      return store_cast<float>(from, step, run, to);
    case Stored::f64:
      return store_cast<double>(from, step, run, to);
    case Stored::u8:
      return store_cast<std::uint8_t>(from, step, run, to);
    case Stored::u16:
      return store_cast<std::uint16_t>(from, step, run, to);
    case Stored::u32:
      return store_cast<std::uint32_t>(from, step, run, to);
    case Stored::i64:
      return store_cast<std::int64_t>(from, step, run, to);
    case Stored::colour_byte:
    case Stored::packed_rgb:
    case Stored::whole_s:
    case Stored::rest_ns:
      break;
  }
  if constexpr (std::is_same_v<From, std::int64_t>) {
    const auto part = same.front().stored == Stored::whole_s ? stored_seconds : stored_nanoseconds;
    store_run<std::uint32_t>(from, step, run, to,
                             [part](const std::int64_t* value) { return part(*value); });
  }
  if constexpr (std::is_same_v<From, float>) {
    if (same.front().stored == Stored::packed_rgb)
      return store_run<std::uint32_t>(from, step, run, to, packed_rgb);
    store_run<std::uint8_t>(from, step, run, to,
                            [](const float* value) { return colour_byte(*value); });
  }
}

void pack_fields(std::span<const PointField> same, std::size_t first_row, const Places& to) {
  const PointField& field = same.front();
  const std::size_t step = field.column->components.size();
  std::visit(
      [&](const auto& values) {
        store_fields(values.data() + first_row * step + field.component, step, same, to);
      },
      field.column->values);
}

/// Number of leading fields that are adjacent in one column and have the same stored type, so that
/// one pass can copy them together.
std::size_t run_length(std::span<const PointField> fields) {
  std::size_t run = 1;
  while (run < fields.size() && fields[run].column == fields[0].column &&
         fields[run].stored == fields[0].stored &&
         fields[run].component == fields[0].component + run)
    ++run;
  return run;
}

template <class T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class T>
void append_number(fmt::memory_buffer& text, T value) {
  if constexpr (std::is_floating_point_v<T>) {
    // fmt would print the sign of a NaN
    if (std::isnan(value)) return text.append(std::string_view("nan"));
  }
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), value);
}

void append_stored(fmt::memory_buffer& text, Stored stored, const std::byte* bytes) {
  switch (stored) {
    case Stored::f32:
      return append_number(text, load<float>(bytes));
    case Stored::f64:
      return append_number(text, load<double>(bytes));
    case Stored::u8:
    case Stored::colour_byte:
      return append_number(text, load<std::uint8_t>(bytes));
    case Stored::u16:
      return append_number(text, load<std::uint16_t>(bytes));
    case Stored::u32:
    case Stored::packed_rgb:
    case Stored::whole_s:
    case Stored::rest_ns:
      return append_number(text, load<std::uint32_t>(bytes));
    case Stored::i64:
      return append_number(text, load<std::int64_t>(bytes));
  }
}

void append_row(fmt::memory_buffer& text, std::span<const PointField> fields, const std::byte* row,
                char separator) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (f > 0) text.push_back(separator);
    append_stored(text, fields[f].stored, row);
    row += type_of(fields[f].stored).bytes;
  }
  text.push_back('\n');
}

void report_progress(const ProgressCallback& progress, std::size_t done, std::size_t count) {
  if (progress) progress(static_cast<double>(done) / static_cast<double>(count));
}

}  // namespace

const StoredType& type_of(Stored stored) {
  static constexpr std::array<StoredType, 10> kTypes = {{
      {4, "f32", "float"},  // in the order of Stored
      {8, "f64", "double"},
      {1, "u8", "uchar"},
      {2, "u16", "ushort"},
      {4, "u32", "uint"},
      {8, "i64", ""},  // PLY has no 64-bit integers
      {1, "u8", "uchar"},
      {4, "packed_rgb", "uint"},
      {4, "u32", "uint"},
      {4, "u32", "uint"},
  }};
  return kTypes[static_cast<std::size_t>(stored)];
}

Stored native_type(const Column& column) {
  constexpr std::array kTypes = {Stored::f32, Stored::f64, Stored::u8,
                                 Stored::u16, Stored::u32, Stored::i64};
  static_assert(kTypes.size() == std::variant_size_v<decltype(Column::values)>);
  return kTypes[column.values.index()];
}

bool is_colour(const Column& column) {
  return column.name == "colour" && column.components.size() == 3 &&
         native_type(column) == Stored::f32;
}

void append_fields(const Column& column, std::vector<PointField>& fields) {
  for (std::size_t c = 0; c < column.components.size(); ++c)
    fields.push_back({column.components[c], &column, c, native_type(column)});
}

void append_split_time(const Column& column, std::vector<PointField>& fields) {
  fields.push_back({column.name + "_sec", &column, 0, Stored::whole_s});
  fields.push_back({column.name + "_nsec", &column, 0, Stored::rest_ns});
}

std::span<PointField> append_pcl_fields(const Column& column, std::vector<PointField>& fields) {
  const std::size_t first = fields.size();
  if (is_colour(column)) {
    fields.push_back({"rgb", &column, 0, Stored::packed_rgb});
  } else {
    append_fields(column, fields);
  }
  return std::span(fields).subspan(first);
}

std::vector<PointField> native_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  for (const Column& column : cloud.columns) append_fields(column, fields);
  return fields;
}

GLIDAR_SIMD bool float_is_enough(const Column& column) {
  constexpr double kFirstCoarse_m = 2048.0;
  constexpr double kHalfStep = 0.5 / (1 << 23);  // of a float, per power of two
  static_assert(kFirstCoarse_m * kHalfStep > kFinePosition_m);
  static_assert(kFirstCoarse_m / 2.0 * kHalfStep <= kFinePosition_m);
  const auto* values = std::get_if<std::vector<double>>(&column.values);
  if (values == nullptr) return true;
  int coarse = 0;  // no early exit, so that the loop can be vectorised
  for (const double value : *values) coarse |= static_cast<int>(std::abs(value) >= kFirstCoarse_m);
  return coarse == 0;
}

std::size_t row_bytes(std::span<const PointField> fields) {
  std::size_t bytes = 0;
  for (const PointField& field : fields) bytes += type_of(field.stored).bytes;
  return bytes;
}

void pack_rows(std::span<const PointField> fields, std::size_t first, std::size_t count,
               std::span<std::byte> rows) {
  const std::size_t stride = row_bytes(fields);
  for (std::size_t done = 0; done < count; done += kBlockRows) {
    Places to = {rows.data() + done * stride, stride, std::min(kBlockRows, count - done)};
    std::span<const PointField> left = fields;
    while (!left.empty()) {
      const std::span<const PointField> same = left.first(run_length(left));
      pack_fields(same, first + done, to);
      to.first += row_bytes(same);
      left = left.subspan(same.size());
    }
  }
}

void write_binary_rows(std::span<const PointField> fields, std::size_t count, AtomicFile& file,
                       const ProgressCallback& progress) {
  const std::size_t stride = row_bytes(fields);
  if (stride == 0) return;
  for (std::size_t first = 0; first < count;) {
    const std::span<std::byte> rows = file.reserve_space(kBlockRows * stride);
    const std::size_t now = std::min(count - first, rows.size() / stride);
    pack_rows(fields, first, now, rows);
    file.take(now * stride);
    first += now;
    report_progress(progress, first, count);
  }
}

void write_text_rows(std::span<const PointField> fields, std::size_t count, char separator,
                     AtomicFile& file, const ProgressCallback& progress) {
  const std::size_t stride = row_bytes(fields);
  if (stride == 0) return;
  std::vector<std::byte> rows(std::min(count, kTextChunkRows) * stride);
  fmt::memory_buffer text;
  for (std::size_t first = 0; first < count; first += kTextChunkRows) {
    const std::size_t now = std::min(kTextChunkRows, count - first);
    pack_rows(fields, first, now, rows);
    text.clear();
    for (std::size_t i = 0; i < now; ++i)
      append_row(text, fields, rows.data() + i * stride, separator);
    file.write(std::string_view(text.data(), text.size()));
    report_progress(progress, first + now, count);
  }
}

std::string joined_names(std::span<const PointField> fields, char separator) {
  std::string names;
  for (const PointField& field : fields) {
    if (!names.empty()) names += separator;
    names += field.name;
  }
  return names;
}

}  // namespace glidar

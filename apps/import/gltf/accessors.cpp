// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/accessors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace glidar::import::gltf {
namespace {

/// Elements of accessors without data; more cannot be meant.
constexpr std::size_t kMostZeros = std::size_t{1} << 20U;

Component component_type(const Value& value) {
  const std::size_t number = value.count();
  const auto first = static_cast<std::size_t>(Component::int8);
  const auto last = static_cast<std::size_t>(Component::float32);
  if (number < first || number > last || number == 5124) {
    value.refuse(
        fmt::format("{} is no component type (allowed: 5120 to 5123, 5125, 5126)", number));
  }
  return static_cast<Component>(number);
}

std::size_t component_count(const Value& value) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kTypes = {{{"SCALAR", 1},
                                                                               {"VEC2", 2},
                                                                               {"VEC3", 3},
                                                                               {"VEC4", 4},
                                                                               {"MAT2", 4},
                                                                               {"MAT3", 9},
                                                                               {"MAT4", 16}}};
  const std::string type = value.text();
  for (const auto& [name, count] : kTypes) {
    if (type == name) return count;
  }
  value.refuse(in_quotes(type) + " is no type of an accessor");
}

/// The bytes from the first element to the end of the last. Checks them against the view.
std::string_view elements_in(const Value& object, std::string_view view, std::size_t count,
                             std::size_t stride, std::size_t size) {
  const std::size_t offset = object["byteOffset"].count_or(0);
  const bool starts_inside = offset <= view.size() && size <= view.size() - offset;
  const bool fits = count == 0 || (starts_inside && stride > 0 &&
                                   (count - 1) <= (view.size() - offset - size) / stride);
  if (!fits) {
    object.refuse(
        fmt::format("{} elements of {} bytes from byte {} on do not fit its buffer view "
                    "of {} bytes",
                    count, size, offset, view.size()));
  }
  return count == 0 ? std::string_view{} : view.substr(offset, (count - 1) * stride + size);
}

/// One component as stored.
template <class T>
T stored(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Copies the `n` components of an element. Signed ones are not read as unsigned integers.
template <class T, class Number>
void copy_element(const char* from, std::size_t n, Number* to) {
  if constexpr (std::is_floating_point_v<Number> || std::is_unsigned_v<T>) {
    for (std::size_t k = 0; k < n; ++k)
      to[k] = static_cast<Number>(stored<T>(from + k * sizeof(T)));
  }
}

/// All components as stored.
template <class Number>
std::vector<Number> read_stored(const Accessor& accessor) {
  return with_type(accessor.type, [&](auto zero) {
    using T = decltype(zero);
    const std::size_t n = accessor.components;
    std::vector<Number> all(accessor.count * n);
    const std::size_t given = accessor.bytes.empty() ? 0 : accessor.count;
    for (std::size_t i = 0; i < given; ++i)
      copy_element<T>(accessor.bytes.data() + i * accessor.stride, n, all.data() + i * n);
    if (!accessor.sparse) return all;
    const char* value = accessor.sparse->values.data();
    for (const std::uint32_t i : accessor.sparse->indices) {
      copy_element<T>(value, n, all.data() + i * n);
      value += n * sizeof(T);
    }
    return all;
  });
}

/// The accessor, of unsigned integers.
const Accessor& checked_integers(const Accessor& accessor) {
  const bool fits = accessor.type == Component::uint8 || accessor.type == Component::uint16 ||
                    accessor.type == Component::uint32;
  if (!fits || accessor.normalized) {
    refuse(accessor.path + ".componentType", "unsigned integers are needed (5121, 5123, 5125)");
  }
  return accessor;
}

Sparse read_sparse(const Value& sparse, const Accessor& accessor, Buffers& buffers) {
  const std::size_t count = sparse.required("count").count();
  const Value indices = sparse.required("indices");
  const Value values = sparse.required("values");
  Accessor list;
  list.path = indices.path();
  list.count = count;
  list.components = 1;
  list.type = component_type(indices.required("componentType"));
  list.stride = size_of(list.type);
  const View view = buffers.view(indices.required("bufferView"));
  list.bytes = elements_in(indices, view.bytes, count, list.stride, list.stride);
  Sparse read;
  read.indices = read_stored<std::uint32_t>(checked_integers(list));
  for (std::size_t i = 0; i < count; ++i) {
    if (read.indices[i] >= accessor.count) {
      indices.refuse(fmt::format("index {} of {} elements", read.indices[i], accessor.count));
    }
    if (i > 0 && read.indices[i] <= read.indices[i - 1]) {
      indices.refuse(fmt::format("index {} after {}: they must increase", read.indices[i],
                                 read.indices[i - 1]));
    }
  }
  const std::size_t size = accessor.components * size_of(accessor.type);
  const View data = buffers.view(values.required("bufferView"));
  read.values = elements_in(values, data.bytes, count, size, size);
  return read;
}

/// Exporters round the stated limits, by a thousandth at most.
bool is_close(double stated, double found, double extent) {
  constexpr double kRounding = 1e-3;
  return std::abs(stated - found) <= kRounding * extent + 1e-6 * std::abs(found);
}

void report_limit(const Accessor& accessor, const std::string& limit, const std::string& what,
                  Notes& notes) {
  const std::string path = accessor.path + "." + limit;
  if (accessor.needs_limits) {
    refuse(path, what, "the data or the limits are damaged: export the file again");
  }
  notes.add_at(path, what);
}

template <class Number>
void check_limits(const Accessor& accessor, const std::vector<Number>& stored_values,
                  Notes& notes) {
  const bool is_stated = !accessor.min.empty() || !accessor.max.empty();
  const bool has_data = !accessor.bytes.empty() || accessor.sparse;
  if (!is_stated || !has_data) return;
  const std::size_t n = accessor.components;
  std::vector<double> low(n, std::numeric_limits<double>::infinity());
  std::vector<double> high(n, -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < accessor.count; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const auto value = static_cast<double>(stored_values[i * n + k]);
      if (!std::isfinite(value)) continue;  // such triangles are left out, with a note
      low[k] = std::min(low[k], value);
      high[k] = std::max(high[k], value);
    }
  }
  double extent = 0.0;
  for (std::size_t k = 0; k < n; ++k) extent = std::max(extent, high[k] - low[k]);
  const auto check = [&](const char* name, const std::vector<double>& limits,
                         const std::vector<double>& found) {
    for (std::size_t k = 0; k < limits.size(); ++k) {
      if (low[k] > high[k] || is_close(limits[k], found[k], extent)) continue;
      report_limit(accessor, fmt::format("{}[{}]", name, k),
                   fmt::format("{} is stated, the data has {}", limits[k], found[k]), notes);
    }
  };
  check("min", accessor.min, low);
  check("max", accessor.max, high);
}

}  // namespace

double largest_of(Component type) {
  return with_type(type,
                   [](auto zero) { return double{std::numeric_limits<decltype(zero)>::max()}; });
}

std::size_t size_of(Component type) {
  return with_type(type, [](auto zero) { return sizeof zero; });
}

Accessor describe_accessor(const Value& value) {
  Accessor accessor;
  accessor.path = value.path();
  accessor.count = value.required("count").count();
  accessor.components = component_count(value.required("type"));
  accessor.type = component_type(value.required("componentType"));
  accessor.normalized = value["normalized"].flag_or(false);
  const bool is_number = accessor.type == Component::float32 || accessor.type == Component::uint32;
  if (accessor.normalized && is_number) {
    value["normalized"].refuse("only integers of 8 and 16 bits can be normalized");
  }
  if (value["min"]) accessor.min = value["min"].numbers(accessor.components);
  if (value["max"]) accessor.max = value["max"].numbers(accessor.components);
  return accessor;
}

Accessor open_accessor(const Document& document, Buffers& buffers, const Value& index) {
  const Value value = document.target("accessors", index);
  Accessor accessor = describe_accessor(value);
  const std::size_t size = accessor.components * size_of(accessor.type);
  if (value["bufferView"]) {
    const View view = buffers.view(value["bufferView"]);
    accessor.stride = view.stride == 0 ? size : view.stride;
    if (accessor.stride < size) {
      value.refuse(
          fmt::format("elements of {} bytes overlap: byteStride is {}", size, accessor.stride));
    }
    accessor.bytes = elements_in(value, view.bytes, accessor.count, accessor.stride, size);
  } else if (accessor.count > kMostZeros) {
    value.refuse(fmt::format("{} elements without data", accessor.count));
  }
  buffers.take(Budget::numbers, accessor.count * accessor.components, accessor.path);
  const Value sparse = value["sparse"];
  if (sparse) accessor.sparse = read_sparse(sparse, accessor, buffers);
  return accessor;
}

std::vector<double> read_numbers(const Accessor& accessor, Notes& notes) {
  std::vector<double> values = read_stored<double>(accessor);
  check_limits(accessor, values, notes);
  if (!accessor.normalized) return values;
  const double one = largest_of(accessor.type);
  for (double& value : values) value = std::max(value / one, -1.0);
  return values;
}

std::vector<std::uint32_t> read_integers(const Accessor& accessor, Notes& notes) {
  std::vector<std::uint32_t> values = read_stored<std::uint32_t>(checked_integers(accessor));
  check_limits(accessor, values, notes);
  return values;
}

}  // namespace glidar::import::gltf

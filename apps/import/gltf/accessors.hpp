// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/buffers.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import::gltf {

/// Component types of glTF 2.0, 3.6.2.2.
enum class Component : std::uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

/// Calls `read` with a zero of the type of the components.
template <class Read>
auto with_type(Component type, const Read& read) {
  switch (type) {
    case Component::int8:
      return read(std::int8_t{});
    case Component::uint8:
      return read(std::uint8_t{});
    case Component::int16:
      return read(std::int16_t{});
    case Component::uint16:
      return read(std::uint16_t{});
    case Component::uint32:
      return read(std::uint32_t{});
    case Component::float32:
      break;
  }
  return read(float{});
}

/// Values that replace others of an accessor.
struct Sparse {
  std::vector<std::uint32_t> indices;  ///< strictly increasing, below the accessor's count
  std::string_view values;             ///< packed
};

/// A typed view of bytes; all sizes are checked.
struct Accessor {
  std::string path;            ///< for errors
  std::size_t count = 0;       ///< elements
  std::size_t components = 0;  ///< of each element
  Component type = Component::float32;
  bool normalized = false;
  std::string_view bytes;  ///< of the first element and those after it; empty: all are zero
  std::size_t stride = 0;  ///< bytes from element to element
  std::optional<Sparse> sparse;
  std::vector<double> min;  ///< as stated, of each component; empty: not stated
  std::vector<double> max;
  bool needs_limits = false;  ///< the standard requires them: of positions
};

/// The accessor that `index` names. Throws Refusal for one outside its buffer, of an unknown type
/// or with sparse indices that do not increase.
Accessor open_accessor(const Document& document, Buffers& buffers, const Value& index);

/// The shape of an accessor alone, without its data (KHR_draco_mesh_compression replaces them).
Accessor describe_accessor(const Value& accessor);

std::size_t size_of(Component type);

/// The integer that means 1 when normalized.
double largest_of(Component type);

/// All components of all elements, as numbers: c / 65535 and the like for normalized integers (glTF
/// 2.0, 3.11). If the stated minimum or maximum is not that of the data, adds a note, or throws
/// Refusal where the standard requires it.
std::vector<double> read_numbers(const Accessor& accessor, Notes& notes);

/// The same, as integers: indices, joints. Throws Refusal for other component types too.
std::vector<std::uint32_t> read_integers(const Accessor& accessor, Notes& notes);

}  // namespace glidar::import::gltf

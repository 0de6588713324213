// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t size_of(PlyType type);  ///< bytes

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> count;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::uint64_t line = 0;

  /// The first property with the first of the names that one has; kNone: none.
  [[nodiscard]] std::size_t find(std::initializer_list<std::string_view> names) const;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
};

enum class PlyEncoding : std::uint8_t { ascii, little, big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< of "comment TextureFile NAME"
  Notes notes;
  std::size_t size = 0;  ///< bytes
  std::uint64_t lines = 0;
};

/// Reads the lines up to 'end_header'. Throws Refusal for the first one that is damaged.
PlyHeader read_ply_header(std::string_view file);

}  // namespace glidar::import

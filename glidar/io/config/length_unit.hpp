// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace glidar {

/// A unit that a model file's numbers may be in, as scene files and options name it.
struct LengthUnit {
  const char* name;
  double metres;
};

inline constexpr std::array<LengthUnit, 4> kLengthUnits = {
    {{"mm", 0.001}, {"cm", 0.01}, {"m", 1.0}, {"in", 0.0254}}};

/// The names, in the same order.
inline std::vector<std::string> length_unit_names() {
  std::vector<std::string> names;
  for (const LengthUnit& unit : kLengthUnits) names.emplace_back(unit.name);
  return names;
}

}  // namespace glidar

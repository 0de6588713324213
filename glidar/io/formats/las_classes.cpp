// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_classes.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace glidar {
namespace {

struct StandardClass {
  std::string_view name;
  std::uint8_t code;
};

/// Names of classes with the codes of LAS Specification 1.4 R15, table 17.
constexpr StandardClass kStandardClasses[] = {
    {"unclassified", 1},
    {"unlabelled", 1},
    {"ground", 2},
    {"terrain", 2},
    {"soil", 2},
    {"sand", 2},
    {"pavement", 2},
    {"sidewalk", 2},
    {"low_vegetation", 3},
    {"grass", 3},
    {"medium_vegetation", 4},
    {"vegetation", 4},
    {"bush", 4},
    {"shrub", 4},
    {"hedge", 4},
    {"high_vegetation", 5},
    {"tree", 5},
    {"trunk", 5},
    {"building", 6},
    {"house", 6},
    {"roof", 6},
    {"low_noise", 7},
    {"noise", 7},
    {"water", 9},
    {"river", 9},
    {"lake", 9},
    {"rail", 10},
    {"railway", 10},
    {"road", 11},
    {"road_surface", 11},
    {"street", 11},
    {"parking", 11},
    {"wire_guard", 13},
    {"shield_wire", 13},
    {"wire", 14},
    {"wire_conductor", 14},
    {"power_line", 14},
    {"transmission_tower", 15},
    {"pylon", 15},
    {"wire_structure_connector", 16},
    {"insulator", 16},
    {"bridge", 17},
    {"bridge_deck", 17},
    {"high_noise", 18},
    {"overhead_structure", 19},
    {"conveyor", 19},
    {"traffic_light", 19},
    {"ignored_ground", 20},
    {"snow", 21},
};

}  // namespace

std::uint8_t las_standard_class(std::string_view name) {
  std::string word = lower_case(name);
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  for (const StandardClass& standard : kStandardClasses) {
    if (standard.name == word) return standard.code;
  }
  return 0;
}

std::vector<std::uint8_t> las_class_codes(std::span<const std::string> class_names) {
  constexpr std::size_t kBeforeUser = 63;  // 64 to 255 are user-definable
  std::vector<std::uint8_t> codes;
  for (std::size_t id = 0; id < class_names.size(); ++id) {
    const std::uint8_t standard = las_standard_class(class_names[id]);
    const std::size_t user = kBeforeUser + id;
    const bool fits = id > 0 && user <= std::numeric_limits<std::uint8_t>::max();
    const std::uint8_t other = fits ? static_cast<std::uint8_t>(user) : kLasUnclassified;
    codes.push_back(standard != 0 ? standard : other);
  }
  return codes;
}

}  // namespace glidar

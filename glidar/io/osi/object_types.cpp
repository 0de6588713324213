// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/object_types.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace glidar::osi {
namespace {

constexpr std::uint64_t kPedestrianType = 3;
constexpr std::uint64_t kAnimalType = 4;

/// A value of an enumeration and the class that selects it.
struct NamedType {
  std::string_view class_name;
  std::uint64_t value;
};

/// MovingObject::Type of what is no vehicle.
constexpr std::array kMovingTypes = {
    NamedType{"pedestrian", kPedestrianType},
    NamedType{"person", kPedestrianType},
    NamedType{"people", kPedestrianType},
    NamedType{"human", kPedestrianType},
    NamedType{"adult", kPedestrianType},
    NamedType{"child", kPedestrianType},
    NamedType{"animal", kAnimalType},
    NamedType{"dog", kAnimalType},
    NamedType{"cat", kAnimalType},
    NamedType{"horse", kAnimalType},
    NamedType{"cow", kAnimalType},
    NamedType{"sheep", kAnimalType},
    NamedType{"deer", kAnimalType},
    NamedType{"bird", kAnimalType},
};

/// MovingObject::VehicleClassification::Type.
constexpr std::array kVehicleTypes = {
    NamedType{"vehicle", kOtherType},
    NamedType{"car", 4},
    NamedType{"small_car", 2},
    NamedType{"compact_car", 3},
    NamedType{"medium_car", 4},
    NamedType{"luxury_car", 5},
    NamedType{"van", 6},
    NamedType{"delivery_van", 6},
    NamedType{"truck", 7},
    NamedType{"heavy_truck", 7},
    NamedType{"lorry", 7},
    NamedType{"semitrailer", 8},
    NamedType{"trailer", 9},
    NamedType{"motorcycle", 10},
    NamedType{"motorbike", 10},
    NamedType{"motorcyclist", 10},
    NamedType{"bicycle", 11},
    NamedType{"bike", 11},
    NamedType{"cyclist", 11},
    NamedType{"bicyclist", 11},
    NamedType{"bus", 12},
    NamedType{"tram", 13},
    NamedType{"train", 14},
    NamedType{"wheelchair", 15},
    NamedType{"semitractor", 16},
    NamedType{"standup_scooter", 17},
    NamedType{"scooter", 17},
    NamedType{"work_machine", 19},
    NamedType{"tractor", 19},
    NamedType{"excavator", 19},
    NamedType{"watercraft", 20},
    NamedType{"boat", 20},
    NamedType{"ship", 20},
    NamedType{"aircraft", 21},
    NamedType{"airplane", 21},
    NamedType{"helicopter", 21},
};

constexpr std::array kStationaryTypes = {
    NamedType{"bridge", 2},  NamedType{"building", 3},    NamedType{"pole", 4},
    NamedType{"pylon", 5},   NamedType{"delineator", 6},  NamedType{"tree", 7},
    NamedType{"barrier", 8}, NamedType{"vegetation", 9},  NamedType{"curbstone", 10},
    NamedType{"wall", 11},   NamedType{"speed_bump", 17},
};

std::string normalised(std::string_view class_name) {
  std::string name = lower_case(class_name);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

/// The value of a name; 0 if it is not in the table.
template <std::size_t Count>
std::uint64_t value_in(const std::array<NamedType, Count>& types, std::string_view name) {
  const auto found = std::find_if(types.begin(), types.end(), [name](const NamedType& type) {
    return type.class_name == name;
  });
  return found != types.end() ? found->value : 0;
}

}  // namespace

MovingType moving_type(std::string_view class_name) {
  const std::string name = normalised(class_name);
  if (const std::uint64_t vehicle = value_in(kVehicleTypes, name)) return {kVehicleType, vehicle};
  const std::uint64_t type = value_in(kMovingTypes, name);
  return {.type = type != 0 ? type : kOtherType};
}

std::uint64_t stationary_type(std::string_view class_name) {
  const std::uint64_t type = value_in(kStationaryTypes, normalised(class_name));
  return type != 0 ? type : kOtherType;
}

}  // namespace glidar::osi

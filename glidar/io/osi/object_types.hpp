// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/osi: values of enumerations in osi_object.proto of OSI 3.8.

#include <cstdint>
#include <string_view>

namespace glidar::osi {

inline constexpr std::uint64_t kOtherType = 1;    ///< of all enumerations of types
inline constexpr std::uint64_t kVehicleType = 2;  ///< of MovingObject::Type

/// The types of a moving object.
struct MovingType {
  std::uint64_t type = kOtherType;          ///< MovingObject::Type
  std::uint64_t vehicle_type = kOtherType;  ///< MovingObject::VehicleClassification::Type
};

/// The types of a class, by its name in any case, with spaces, '-' or '_' between words; other
/// names have the type "other".
MovingType moving_type(std::string_view class_name);

/// StationaryObject::Classification::Type of a class, by the same rules for names.
std::uint64_t stationary_type(std::string_view class_name);

}  // namespace glidar::osi

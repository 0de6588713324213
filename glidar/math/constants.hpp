// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

namespace glidar {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr float kNaNf = std::numeric_limits<float>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kInfinityf = std::numeric_limits<float>::infinity();

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< radians
/// Rounded separately, so not bit-identical to 1 / kDegree.
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kMillimetre_m = 1e-3;
inline constexpr double kMicrosecond_ns = 1e3;
inline constexpr double kSecond_ns = 1e9;

/// Speed of light in vacuum, exact by the definition of the metre.
inline constexpr double kLight_m_per_s = 299792458.0;

/// Range per round-trip time of flight.
inline constexpr double kHalfLight_m_per_s = 0.5 * kLight_m_per_s;

}  // namespace glidar

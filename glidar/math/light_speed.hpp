// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// Speed of light in vacuum, exact by the definition of the metre.
inline constexpr double kLight_m_per_s = 299792458.0;

/// Range per round-trip time of flight.
inline constexpr double kHalfLight_m_per_s = 0.5 * kLight_m_per_s;

}  // namespace glidar

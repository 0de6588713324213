// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// Of light in vacuum, exact by the metre's definition.
inline constexpr double kLight_m_per_s = 299792458.0;

/// Range per time of flight: light goes there and back.
inline constexpr double kHalfLight_m_per_s = 0.5 * kLight_m_per_s;

}  // namespace glidar

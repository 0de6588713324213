// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

namespace glidar {

/// Power of projectors, W, and irradiance, W/m²: so that numbers of electrons are finite.
inline constexpr NumberRule kLightPowerRule = {0.0, 1e6, false, "a number from 0 to 1e6"};

}  // namespace glidar

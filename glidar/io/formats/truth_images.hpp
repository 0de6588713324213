// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// The pixels of .rgb.png as 8-bit RGB: the surface's colour times the cosine of incidence, as lit
/// by a light at the sensor without attenuation. Of the columns `colour` and `incidence`.
std::vector<std::uint8_t> rgb_pixels(const PointCloud& cloud);

}  // namespace glidar

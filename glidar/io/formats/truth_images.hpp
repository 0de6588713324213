// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

// Images of the ground truth as 8-bit or 16-bit PNG, 0 where beams hit nothing. Errors state which
// number is out of range.
Format rgb_png_format();
Format normal_png_format();
Format instance_png_format();
Format class_png_format();

/// The pixels of .rgb.png as 8-bit RGB: the surface's colour times the cosine of incidence, as lit
/// by a light at the sensor without attenuation. Of the columns `colour` and `incidence`.
std::vector<std::uint8_t> rgb_pixels(const PointCloud& cloud);

}  // namespace glidar

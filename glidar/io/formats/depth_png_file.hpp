// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes a 16-bit grey image: depth times options.depth_png_units_per_m, rounded, at least 1; 0:
/// no return. Throws Error when a depth is behind the sensor or above 65535 units.
void write_depth_png(const CloudFile& job, AtomicFile& file);

}  // namespace glidar

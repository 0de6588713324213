// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// Depth as 16-bit PNG.
Format depth_png_format();

/// Range along the beam as 16-bit PNG.
Format range_png_format();

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// OpenEXR image with a channel for each number of a pixel: depth as Z, and all columns of the
/// cloud as 32-bit float or unsigned integer. Columns of 64-bit integers are omitted, as the
/// format has no type for them.
Format exr_format();

}  // namespace glidar

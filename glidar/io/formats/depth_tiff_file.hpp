// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// Depth as TIFF with 32-bit floats.
Format depth_tiff_format();

}  // namespace glidar

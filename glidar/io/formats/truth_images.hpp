// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

// Images of the ground truth as 8-bit or 16-bit PNG, 0 where beams hit nothing. Errors state which
// number is out of range.
Format rgb_png_format();
Format normal_png_format();
Format instance_png_format();
Format class_png_format();

}  // namespace glidar

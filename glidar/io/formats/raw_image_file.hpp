// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/format.hpp>

namespace glidar {

/// Frame::raw_images of the names "ir_left", "ir_right" and "ir_reference".
Format ir_left_png_format();
Format ir_right_png_format();
Format ir_reference_png_format();

/// Frame::raw_images "pattern_00" ... of a structured-light camera as a NumPy array of uint8 or
/// uint16, images x rows x columns.
Format patterns_npy_format();

}  // namespace glidar

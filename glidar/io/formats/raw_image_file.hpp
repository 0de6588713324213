// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/grey_image.hpp>
#include <glidar/io/formats/format.hpp>

#include <filesystem>
#include <vector>

namespace glidar {

/// Frame::raw_images of the names "ir_left", "ir_right" and "ir_reference".
Format ir_left_png_format();
Format ir_right_png_format();
Format ir_reference_png_format();

/// Frame::raw_images "pattern_00" ... of a structured-light camera as a NumPy array of uint8 or
/// uint16, images x rows x columns.
Format patterns_npy_format();

/// Such an array. Throws Error naming the file.
std::vector<GreyImage> load_pattern_images(const std::filesystem::path& path);

}  // namespace glidar

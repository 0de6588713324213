// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/tof_images.hpp>
#include <glidar/io/formats/format.hpp>

#include <filesystem>

namespace glidar {

/// Active brightness of a time-of-flight camera: Frame::tof_amplitude, rounded.
Format ir_png_format();

/// Frame::tof_images as a NumPy array of float32, frequencies x phase steps x rows x columns.
Format tof_npy_format();

/// Such an array, of any real type. Throws Error naming the file.
TofImages load_tof_images(const std::filesystem::path& path);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>
#include <glidar/io/formats/format.hpp>

#include <filesystem>

namespace glidar {

/// The images of a file of tof_npy_format(), of any real type. Throws Error naming the file.
TofImages load_tof_images(const std::filesystem::path& path);

}  // namespace glidar

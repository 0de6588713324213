// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>
#include <glidar/io/formats/format.hpp>

#include <filesystem>
#include <vector>

namespace glidar {

/// The images of a file of patterns_npy_format(). Throws Error naming the file.
std::vector<GreyImage> load_pattern_images(const std::filesystem::path& path);

}  // namespace glidar

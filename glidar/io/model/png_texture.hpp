// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>

#include <filesystem>

namespace glidar {

/// Reads a PNG file as 8 bit texels, grey or rgb, with alpha where the file has it. Throws Error
/// when it is missing, corrupt or larger than 16384 pixels per side or 256 MiB of texels.
Texture read_png_texture(const std::filesystem::path& file);

}  // namespace glidar

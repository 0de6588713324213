// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project: pictures of beam patterns.

#include <glidar/core/beams.hpp>

#include <filesystem>

namespace glidar {

/// Writes a PNG of the beam directions: azimuth (left of the boresight is left) and elevation in
/// degrees, with axes, coloured by firing time, or by ring when all fire at the same time. For
/// images a part of the pixels is drawn. Throws Error when there is no beam or the file cannot be
/// written.
void write_pattern_picture(const Beams& beams, const std::filesystem::path& path);

}  // namespace glidar

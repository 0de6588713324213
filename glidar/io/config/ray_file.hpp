// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: files that list beams.

#include <glidar/sensor/optics/ray_table.hpp>

#include <filesystem>

namespace glidar {

/// A text table "Time/s,Azimuth/deg,Zenith/deg" (the Livox simulation plugin's scan_mode files), to
/// be played again and again. Throws Error naming file and line.
RayTable load_scan_csv(const std::filesystem::path& path);

/// An array of doubles or floats, N x 3 (directions) or N x 6 (origins in metres, directions), or
/// rows x cols x 3 or 6. Without times. Throws Error.
RayTable load_ray_npy(const std::filesystem::path& path);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/spinning.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// Reads the optics from a sensor's metadata JSON, of old and new firmware. Throws Error with the
/// key that is missing or malformed.
Spinning load_ouster_metadata(const std::filesystem::path& path);

/// The same from a text; `file` is where it comes from, for errors.
Spinning parse_ouster_metadata(const std::string& text, const std::string& file);

}  // namespace glidar

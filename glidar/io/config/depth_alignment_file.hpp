// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/depth_alignment.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The two cameras of a YAML file (docs/depth-filters.md). Throws Error with the place in the
/// file.
DepthAlignment load_depth_alignment(const std::filesystem::path& path);

/// The same of a text in YAML or JSON.
DepthAlignment parse_depth_alignment(const std::string& text);

}  // namespace glidar

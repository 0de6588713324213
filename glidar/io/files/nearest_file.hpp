// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar {

/// The name in a path's folder that is most similar to the path's file name; empty when none is
/// similar. For suggestions when a file is missing.
std::string nearest_file(const std::filesystem::path& path);

}  // namespace glidar

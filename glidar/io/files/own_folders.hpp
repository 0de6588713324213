// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <filesystem>
#include <vector>

namespace glidar {

/// Folders that contain the installed files of this code (share/glidar, libexec/glidar), so
/// that a moved installation finds its files: those of the shared library with this code (its
/// own folder and the one above), else the one above the running program's.
std::vector<std::filesystem::path> own_folders();

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: finds the data files that are installed with GLIDAR.

#include <filesystem>
#include <string>

namespace glidar {

/// The folder `name` of GLIDAR's data: the value of the environment variable, next to the
/// running program or library (share/glidar/name), in the source, or where it is installed. Throws
/// Error when there is none.
std::filesystem::path data_folder(const std::string& name, const char* variable);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Folders that contain the installed files of this code (share/glidar, libexec/glidar), so
/// that a moved installation finds its files: those of the shared library with this code (its
/// own folder and the one above), else the one above the running program's.
std::vector<std::filesystem::path> own_folders();

/// The folder `name` of GLIDAR's data: the value of the environment variable, next to the
/// running program or library (share/glidar/name), in the source, or where it is installed. Throws
/// Error when there is none.
std::filesystem::path data_folder(const std::string& name, const char* variable);

/// Throws Error unless a path of a recording or sidecar is valid: not empty, at most 4096 bytes,
/// without control characters or zero bytes (which would end it for the system). `where` is
/// the file, with the line if it has several; `key` the purpose of the path.
void check_recorded_path(const std::string& where, std::string_view key, std::string_view path);

/// The same for an argument of a recorded command, which may be empty and longer.
void check_recorded_argument(const std::string& where, std::string_view argument);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

/// The absolute folders in a list separated by ':', such as PATH, in order. Empty and relative
/// entries mean the current folder or one in it; they are left out.
std::vector<std::filesystem::path> absolute_folders(std::string_view list);

/// Folders as such a list.
std::string joined_folders(const std::vector<std::filesystem::path>& folders);

/// The absolute folders in PATH; without PATH the system's default.
std::vector<std::filesystem::path> program_folders();

/// The programs of this name in the folders: executable regular files.
std::vector<std::filesystem::path> find_programs(std::string_view name,
                                                 const std::vector<std::filesystem::path>& folders);

}  // namespace glidar::app

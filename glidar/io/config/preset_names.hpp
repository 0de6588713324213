// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how presets are named.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// A name as names are compared: small letters, without '-', '_' and ' '.
std::string normalised_name(std::string_view name);

/// The element of `names` that is equal, else the one whose normalised name is; empty: none.
std::string match_name(const std::string& name, const std::vector<std::string>& names);

/// "did you mean A, B or C?" with the nearest names; if none is near, `otherwise`.
std::string nearest_names(const std::string& name, std::vector<std::string> names,
                          const std::string& otherwise);

/// Whether a file's name ends in .yaml or .yml.
bool is_yaml(const std::filesystem::path& path);

/// The YAML files of a folder, sorted; none if there is no such folder.
std::vector<std::filesystem::path> yaml_files(const std::filesystem::path& folder);

}  // namespace glidar

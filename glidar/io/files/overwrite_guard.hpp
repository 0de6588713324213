// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// The path without symbolic links in its folders; "..", also after a link, as the system resolves
/// it.
std::filesystem::path real_path(const std::filesystem::path& path);

/// True for two names of one file, also if it does not exist yet.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// All files that the models of a scene were read from: including textures, materials and buffers.
std::vector<std::string> files_of(const Scene& scene);

/// Throws Error when `output` is an input file.
void refuse_overwrite_of_inputs(std::span<const std::string> read,
                                const std::filesystem::path& output);

}  // namespace glidar

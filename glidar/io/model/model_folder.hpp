// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// Where a model may read from.
struct ModelFolder {
  std::filesystem::path folder;  ///< of the model file itself, canonical
  std::filesystem::path root;    ///< nothing outside is ever opened; `folder` or its parent
  std::vector<std::filesystem::path> also;  ///< more folders to look for textures in: those of the
                                            ///< material files that the model names
};

/// The folders of a model, given its canonical path. The root is the model's own folder, except in
/// a model package (as Gazebo's), where it is the parent: when the parent holds a `model.config`,
/// or the model lies in a folder `meshes` that has a folder `materials` beside it.
ModelFolder model_folder(const std::filesystem::path& canonical_model);

/// True when `path` is `root` or below it; both absolute and normalised.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& root);

enum class Access : std::uint8_t { granted, absent, outside, not_a_file };

struct ConfinedFile {
  Access access = Access::absent;
  std::filesystem::path path;  ///< canonical; only when granted
};

/// Resolves a path (relative ones from the model's folder) with all its symbolic links, and grants
/// it only if it is a regular file inside the root.
ConfinedFile confine(const std::filesystem::path& wanted, const ModelFolder& folder);

/// In words, for messages; empty when granted.
std::string reason(Access access);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// The folders that a model may read.
struct ModelFolder {
  std::filesystem::path folder;                         ///< of the model file itself, canonical
  std::filesystem::path root;                           ///< `folder` or its parent
  std::vector<std::filesystem::path> material_folders;  ///< more folders to search for textures:
                                                        ///< those of the model's material files
  /// ModelOptions::texture_folders, canonical. No file outside of them and the root is ever opened.
  std::vector<std::filesystem::path> texture_folders = {};

  /// The root and the texture folders.
  [[nodiscard]] std::vector<std::filesystem::path> allowed() const;
};

/// The folders of a model, given its canonical path. The root is the model's own folder, except in
/// a model package (as Gazebo's), where it is the parent: when the parent contains a
/// `model.config`, or the model is in a folder `meshes` next to a folder `materials`.
ModelFolder model_folder(const std::filesystem::path& canonical_model,
                         std::vector<std::filesystem::path> texture_folders = {});

/// True when `path` is `root` or below it; both absolute and normalised.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& root);

enum class Access : std::uint8_t { granted, absent, outside, not_a_file };

struct ConfinedFile {
  Access access = Access::absent;
  std::filesystem::path path;  ///< canonical; only when granted
};

/// Resolves a path (relative ones from the model's folder) with all its symbolic links, and grants
/// access only if it is a regular file inside the root or a texture folder.
ConfinedFile confine(const std::filesystem::path& wanted, const ModelFolder& folder);

/// The reason for a denial, for messages; empty when granted.
std::string reason(Access access);

}  // namespace glidar

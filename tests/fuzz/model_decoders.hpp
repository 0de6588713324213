// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace glidar::testing {

/// Reads a model with the reader of GLIDAR's own for its name. Throws Error for what it refuses.
void read_model_file(const std::filesystem::path& file);

/// Reads a material file (MTL). Throws Error if it defines no material.
void read_mtl_file(const std::filesystem::path& file);

/// Decodes an image of a model. Throws Error for what it refuses.
void read_image_file(const std::filesystem::path& file);

/// Makes a COLLADA document, or an archive with one or with 3MF, readable for Assimp. Throws Error
/// for what it refuses.
void read_mended_file(const std::filesystem::path& file);

}  // namespace glidar::testing

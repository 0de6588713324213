// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>

#include <string>

struct aiScene;

namespace glidar::import {

/// What the importer does not report in all its versions.
struct PlyHeader {
  std::string texture;  ///< of "comment TextureFile NAME"; empty: none
};

/// Reads the header of a PLY file; other files have an empty one. Throws Refusal if the file ends
/// within its header.
PlyHeader read_ply_header(FileContent& file);

/// Gives every material of a PLY file the texture of its header.
void add_ply_texture(const PlyHeader& header, aiScene& scene);

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/texture_use.hpp>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace glidar::import {

/// One `map_...` line of a Wavefront material file.
struct MtlTexture {
  std::string material;
  std::string map;  ///< lower case: "map_kd"
  Eigen::Vector2f scale = Eigen::Vector2f::Ones();
  Eigen::Vector2f offset = Eigen::Vector2f::Zero();
};

/// The options `-s` and `-o` of texture lines, which Assimp skips: u' = s u + o.
struct MtlOptions {
  std::vector<MtlTexture> textures;  ///< only those with such options

  /// Sets the transform that the file gives for this texture of this material.
  void refine(const std::string& material, unsigned type, NamedTexture& texture) const;
};

/// Reads the material files among those that were read for a model.
MtlOptions read_mtl_options(const std::vector<std::string>& files);

}  // namespace glidar::import

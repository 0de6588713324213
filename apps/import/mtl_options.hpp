// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace glidar::import {

/// One texture line of a Wavefront material file that has options.
struct MtlTexture {
  std::string material;
  std::string map;                                   ///< lower case: "map_kd"
  std::string name;                                  ///< of the image
  Eigen::Vector2f scale = Eigen::Vector2f::Ones();   ///< -s
  Eigen::Vector2f offset = Eigen::Vector2f::Zero();  ///< -o
  std::optional<float> bump;                         ///< -bm
  bool clamp = false;                                ///< -clamp on
};

/// Texture lines with options. Assimp skips `-s` and `-o`, and loses the name after options that it
/// does not know or that have fewer numbers than it expects.
struct MtlOptions {
  std::vector<MtlTexture> textures;

  /// Corrects Assimp's values for this texture of this material: name, u' = s u + o, clamping.
  void refine(const std::string& material, unsigned type,
              std::optional<NamedTexture>& texture) const;
};

/// Reads the material files of a model.
MtlOptions read_mtl_options(ModelFiles& files);

}  // namespace glidar::import

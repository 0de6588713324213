// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>

#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace glidar::import {

/// Finds and decodes the textures of materials, each once, into the model.
class TextureStore {
 public:
  /// Frees the embedded images of `source` that it decodes.
  TextureStore(SourceModel& source, ModelFolder folder, ModelFiles& files, ImportedModel& imported);

  /// Index of the texture; TextureUse::kNone if it is missing, which is then listed.
  std::int32_t colours(const std::string& name);

  struct NormalMap {
    std::int32_t texture = TextureUse::kNone;
    float scale = 1.0F;  ///< for Material::normal_scale
  };
  /// The same as tangent-space normals; height maps are converted.
  NormalMap normals(const std::string& name);

 private:
  std::int32_t keep(Texture texture);
  std::int32_t decode(const std::string& name);

  SourceModel& source_;
  TextureSearch search_;
  ModelFiles& files_;
  ImportedModel& imported_;
  std::uint64_t budget_ = std::uint64_t{512} << 20U;
  std::map<std::string, std::int32_t> by_name_;
  std::map<std::string, std::int32_t> by_file_;
  std::map<std::int32_t, NormalMap> normals_;  ///< of the image with this index
};

}  // namespace glidar::import

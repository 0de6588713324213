// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/texture_use.hpp>

#include <glidar/math/portable.hpp>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <Eigen/Geometry>

#include <cmath>

namespace glidar::import {
namespace {

constexpr int kGlNearest = 9728;  // GL_NEAREST in glTF samplers

Wrap wrap_mode(const aiMaterial& material, const char* key, aiTextureType type) {
  int mode = aiTextureMapMode_Wrap;
  material.Get(key, type, 0, mode);
  switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
      return Wrap::clamp;
    case aiTextureMapMode_Mirror:
      return Wrap::mirror;
    default:
      return Wrap::repeat;
  }
}

/// glTF: u' = offset + R S u in coordinates with v down, R turning counter-clockwise in the image
/// (KHR_texture_transform). Assimp returns a modified translation, from which the offset is
/// recovered; the result is for v up.
void set_gltf_transform(const aiUVTransform& t, TextureUse& use) {
  const auto c = static_cast<float>(portable_cos(-t.mRotation));
  const auto s = static_cast<float>(portable_sin(-t.mRotation));
  const float sx = t.mScaling.x;
  const float sy = t.mScaling.y;
  const float ox = t.mTranslation.x - 0.5F * sx * (1.0F - c + s);
  const float oy = 1.0F - sy - t.mTranslation.y + 0.5F * sy * (s + c - 1.0F);
  use.uv_scale_rotate << c * sx, -s * sy, s * sx, c * sy;
  use.uv_offset << ox + s * sy, 1.0F - oy - c * sy;
}

/// Assimp's convention for all other formats: scale, translate, then rotate about the image's
/// centre.
void set_transform(const aiUVTransform& t, TextureUse& use) {
  const auto c = static_cast<float>(portable_cos(t.mRotation));
  const auto s = static_cast<float>(portable_sin(t.mRotation));
  const Eigen::Matrix2f turn{{c, -s}, {s, c}};
  const Eigen::Vector2f scale(t.mScaling.x, t.mScaling.y);
  const Eigen::Vector2f moved(t.mTranslation.x, t.mTranslation.y);
  const Eigen::Vector2f middle = Eigen::Vector2f::Constant(0.5F);
  use.uv_scale_rotate = turn * scale.asDiagonal();
  use.uv_offset = turn * (moved - middle) + middle;
}

void read_transform(const aiMaterial& material, aiTextureType type, bool gltf, TextureUse& use) {
  aiUVTransform transform;
  if (material.Get(_AI_MATKEY_UVTRANSFORM_BASE, type, 0, transform) != aiReturn_SUCCESS) return;
  const TextureUse before = use;
  if (gltf) {
    set_gltf_transform(transform, use);
  } else {
    set_transform(transform, use);
  }
  if (!use.uv_scale_rotate.allFinite() || !use.uv_offset.allFinite()) use = before;
}

}  // namespace

std::optional<NamedTexture> texture_of(const aiMaterial& material, unsigned type_number,
                                       bool gltf) {
  const auto type = static_cast<aiTextureType>(type_number);
  aiString name;
  if (material.Get(_AI_MATKEY_TEXTURE_BASE, type, 0, name) != aiReturn_SUCCESS ||
      name.length == 0) {
    return std::nullopt;
  }
  NamedTexture named;
  named.name.assign(name.data, name.length);
  int uv_set = 0;
  material.Get(_AI_MATKEY_UVWSRC_BASE, type, 0, uv_set);
  named.use.uv_set = uv_set == 1 ? 1 : 0;
  named.use.wrap_u = wrap_mode(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
  named.use.wrap_v = wrap_mode(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
  int filter = 0;
  material.Get(_AI_MATKEY_GLTF_MAPPINGFILTER_MAG_BASE, type, 0, filter);
  if (filter == kGlNearest) named.use.filter = Filter::nearest;
  material.Get(_AI_MATKEY_TEXFLAGS_BASE, type, 0, named.flags);
  read_transform(material, type, gltf, named.use);
  return named;
}

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/assimp_material.hpp>

#include <glidar/math/portable.hpp>

#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace glidar::import {
namespace {

constexpr float kMaxShininess = 128.0F;

float within(float value, float low, float high) {
  return std::isfinite(value) ? std::clamp(value, low, high) : low;
}

std::optional<float> number(const aiMaterial& material, const char* key, unsigned type = 0) {
  float value = 0.0F;
  if (material.Get(key, type, 0, value) != aiReturn_SUCCESS) return std::nullopt;
  return value;
}

std::optional<Eigen::Vector3f> colour(const aiMaterial& material, const char* key) {
  aiColor4D c;
  if (material.Get(key, 0, 0, c) != aiReturn_SUCCESS) return std::nullopt;
  return Eigen::Vector3f(within(c.r, 0.0F, 1.0F), within(c.g, 0.0F, 1.0F), within(c.b, 0.0F, 1.0F));
}

/// Assimp's macros expand to a key, a type and an index; only the key is used here.
constexpr const char* key_of(const char* key, unsigned, unsigned) {
  return key;
}

bool without_highlights(const aiMaterial& material) {
  int mode = aiShadingMode_Phong;
  material.Get(AI_MATKEY_SHADING_MODEL, mode);
  return mode == aiShadingMode_Gouraud || mode == aiShadingMode_Flat ||
         mode == aiShadingMode_NoShading;
}

void read_metallic(const aiMaterial& source, float metallic_factor, float roughness, Material& m) {
  const float metallic = within(metallic_factor, 0.0F, 1.0F);
  const float r = within(roughness, 0.0F, 1.0F);
  const Eigen::Vector3f dielectric = Eigen::Vector3f::Constant(0.04F);
  m.diffuse = colour(source, key_of(AI_MATKEY_BASE_COLOR)).value_or(m.diffuse);
  m.specular = (1.0F - r) * (dielectric + metallic * (m.diffuse - dielectric));
  const float r4 = std::max(r * r * r * r, 1e-6F);
  m.shininess = within(2.0F / r4 - 2.0F, 0.0F, kMaxShininess);
}

void read_phong(const aiMaterial& source, Material& m) {
  const float strength =
      within(number(source, key_of(AI_MATKEY_SHININESS_STRENGTH)).value_or(1.0F), 0.0F, 1.0F);
  m.specular = colour(source, key_of(AI_MATKEY_COLOR_SPECULAR)).value_or(Eigen::Vector3f::Zero());
  m.specular *= without_highlights(source) ? 0.0F : strength;
  m.shininess =
      within(number(source, key_of(AI_MATKEY_SHININESS)).value_or(0.0F), 0.0F, kMaxShininess);
}

/// The grey that Assimp gives to surfaces without a material in some formats.
bool is_made_up(const aiMaterial& source) {
  constexpr float kGrey = 0.6F;
  const auto diffuse = colour(source, key_of(AI_MATKEY_COLOR_DIFFUSE));
  return std::string_view(source.GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME && diffuse &&
         (diffuse->array() == kGrey).all();
}

void read_colours(const aiMaterial& source, Material& m) {
  if (is_made_up(source)) return;
  m.diffuse = colour(source, key_of(AI_MATKEY_COLOR_DIFFUSE)).value_or(m.diffuse);
  const auto metallic = number(source, key_of(AI_MATKEY_METALLIC_FACTOR));
  const auto roughness = number(source, key_of(AI_MATKEY_ROUGHNESS_FACTOR));
  const bool specular_glossiness = number(source, key_of(AI_MATKEY_GLOSSINESS_FACTOR)).has_value();
  if (metallic && roughness && !specular_glossiness) {
    read_metallic(source, *metallic, *roughness, m);
  } else {
    read_phong(source, m);
  }
  const auto ambient = colour(source, key_of(AI_MATKEY_COLOR_AMBIENT));
  m.ambient = ambient && !ambient->isZero(0.0F) ? *ambient : m.diffuse;
  m.opacity = within(number(source, key_of(AI_MATKEY_OPACITY)).value_or(1.0F), 0.0F, 1.0F);
}

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

/// Assimp's convention: scale, translate, then rotate about the image's centre.
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

void read_transform(const aiMaterial& material, aiTextureType type, TextureUse& use) {
  aiUVTransform transform;
  if (material.Get(_AI_MATKEY_UVTRANSFORM_BASE, type, 0, transform) != aiReturn_SUCCESS) return;
  const TextureUse before = use;
  set_transform(transform, use);
  if (!use.uv_scale_rotate.allFinite() || !use.uv_offset.allFinite()) use = before;
}

/// The first texture of a type; none without one.
std::optional<NamedTexture> texture_of(const aiMaterial& material, aiTextureType type) {
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
  read_transform(material, type, named.use);
  return named;
}

std::optional<NamedTexture> first_of(const aiMaterial& source,
                                     std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    if (auto named = texture_of(source, type)) return named;
  }
  return std::nullopt;
}

bool uses_alpha(const aiMaterial& source) {
  int flags = 0;
  aiString name;
  const bool has_base =
      source.Get(_AI_MATKEY_TEXTURE_BASE, aiTextureType_BASE_COLOR, 0, name) == aiReturn_SUCCESS &&
      name.length > 0;
  source.Get(_AI_MATKEY_TEXFLAGS_BASE, has_base ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE,
             0, flags);
  return (flags & aiTextureFlags_UseAlpha) != 0;
}

/// Bump strength: the key of several formats.
float bump_strength(const aiMaterial& source) {
  for (const aiTextureType type : {aiTextureType_HEIGHT, aiTextureType_NORMALS}) {
    if (const auto bm = number(source, _AI_MATKEY_OBJ_BUMPMULT_BASE, type)) return *bm;
  }
  return number(source, key_of(AI_MATKEY_BUMPSCALING)).value_or(1.0F);
}

}  // namespace

SourceMaterial assimp_material(const aiMaterial& source) {
  SourceMaterial material;
  const aiString name = source.GetName();
  if (name.length > 0) material.material.name.assign(name.data, name.length);
  read_colours(source, material.material);
  material.diffuse = first_of(source, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
  material.specular = first_of(source, {aiTextureType_SPECULAR});
  material.opacity = first_of(source, {aiTextureType_OPACITY});
  material.normals =
      first_of(source, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_HEIGHT});
  if (material.normals) material.normals->bump = bump_strength(source);
  material.uses_diffuse_alpha = uses_alpha(source);
  return material;
}

}  // namespace glidar::import

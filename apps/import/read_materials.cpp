// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/read_materials.hpp>

#include <import/confined_io.hpp>
#include <import/texture_use.hpp>

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace glidar::import {
namespace {

constexpr float kMaxShininess = 128.0F;
constexpr float kCutoff = 0.5F;

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

void read_colours(const aiMaterial& source, Material& m) {
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

std::optional<NamedTexture> first_of(const aiMaterial& source,
                                     std::initializer_list<aiTextureType> types,
                                     const MaterialContext& context) {
  for (const aiTextureType type : types) {
    auto named = texture_of(source, type, context.gltf);
    context.mtl.refine(source.GetName().C_Str(), type, named);
    if (named) return named;
  }
  return std::nullopt;
}

TextureUse colours_of(const NamedTexture& named, const MaterialContext& context) {
  TextureUse use = named.use;
  use.texture = context.textures.colours(named.name);
  return use;
}

bool has_alpha(const TextureUse& use, const Model& model) {
  if (!use.used()) return false;
  const std::uint32_t channels = model.textures[static_cast<std::size_t>(use.texture)].channels;
  return channels == 2 || channels == 4;
}

/// Partially transparent surfaces are solid, because beams either pass a surface or hit it.
void note_solid(Model& model) {
  add_once(model.notes,
           "blended transparency is shown solid (`opacity` in a scene file lets beams through)");
}

/// The alpha cutoff of a glTF material of mode MASK.
std::optional<float> gltf_cutoff(const aiMaterial& source, const Material& m, Model& model) {
  aiString mode;
  if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS) return std::nullopt;
  if (std::string_view(mode.C_Str()) == "BLEND" &&
      (m.opacity < 1.0F || has_alpha(m.diffuse_texture, model))) {
    note_solid(model);
  }
  if (std::string_view(mode.C_Str()) != "MASK") return std::nullopt;
  return within(number(source, key_of(AI_MATKEY_GLTF_ALPHACUTOFF)).value_or(kCutoff), 0.0F, 1.0F);
}

void read_cutout(const aiMaterial& source, int diffuse_flags, const MaterialContext& context,
                 Model& model, Material& m) {
  if (const auto cutoff = gltf_cutoff(source, m, model)) {
    m.alpha_cutoff = *cutoff;
    if (has_alpha(m.diffuse_texture, model)) m.alpha_texture = m.diffuse_texture;
    return;
  }
  if (const auto opacity = first_of(source, {aiTextureType_OPACITY}, context)) {
    m.alpha_texture = colours_of(*opacity, context);
  } else if ((diffuse_flags & aiTextureFlags_UseAlpha) != 0 &&
             has_alpha(m.diffuse_texture, model)) {
    m.alpha_texture = m.diffuse_texture;
  }
  if (m.alpha_texture.used()) {
    m.alpha_cutoff = kCutoff;
    // The image defines the cut-out; an additional factor (often 0 by mistake) is ignored.
    m.opacity = 1.0F;
  } else if (m.opacity < 1.0F && !context.gltf) {
    note_solid(model);
  }
}

/// Bump strength: OBJ's -bm, the key of other formats, or glTF's normal scale.
float bump_strength(const aiMaterial& source, const NamedTexture& texture) {
  if (texture.bump) return *texture.bump;
  for (const aiTextureType type : {aiTextureType_HEIGHT, aiTextureType_NORMALS}) {
    if (const auto bm = number(source, _AI_MATKEY_OBJ_BUMPMULT_BASE, type)) return *bm;
  }
  if (const auto scale = number(source, _AI_MATKEY_GLTF_SCALE_BASE, aiTextureType_NORMALS)) {
    return *scale;
  }
  return number(source, key_of(AI_MATKEY_BUMPSCALING)).value_or(1.0F);
}

void read_normals(const aiMaterial& source, const MaterialContext& context, Material& m) {
  const auto named = first_of(
      source, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_HEIGHT}, context);
  if (!named) return;
  const TextureStore::NormalMap map = context.textures.normals(named->name);
  if (map.texture == TextureUse::kNone) return;
  m.normal_texture = named->use;
  m.normal_texture.texture = map.texture;
  const float scale = map.scale * bump_strength(source, *named);
  m.normal_scale = std::isfinite(scale) ? scale : map.scale;
}

}  // namespace

Material read_material(const aiMaterial& source, const MaterialContext& context, Model& model) {
  Material m;
  const aiString name = source.GetName();
  if (name.length > 0) m.name.assign(name.data, name.length);
  read_colours(source, m);
  int diffuse_flags = 0;
  if (const auto diffuse =
          first_of(source, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, context)) {
    m.diffuse_texture = colours_of(*diffuse, context);
    diffuse_flags = diffuse->flags;
  }
  if (const auto specular = first_of(source, {aiTextureType_SPECULAR}, context)) {
    m.specular_texture = colours_of(*specular, context);
  }
  read_cutout(source, diffuse_flags, context, model, m);
  read_normals(source, context, m);
  return m;
}

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/read_materials.hpp>

#include <import/model_files.hpp>

#include <cmath>

namespace glidar::import {
namespace {

constexpr float kCutoff = 0.5F;

TextureUse colours_of(const std::optional<NamedTexture>& named, TextureStore& textures) {
  if (!named) return {};
  TextureUse use = named->use;
  use.texture = textures.colours(named->name);
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

void set_cutout(const SourceMaterial& source, TextureStore& textures, Model& model, Material& m) {
  const bool texture_has_alpha = has_alpha(m.diffuse_texture, model);
  if (source.alpha == AlphaMode::cut_out) {
    m.alpha_cutoff = source.cutoff;
    if (texture_has_alpha) m.alpha_texture = m.diffuse_texture;
    return;
  }
  if (source.opacity) {
    m.alpha_texture = colours_of(source.opacity, textures);
  } else if (source.uses_diffuse_alpha && texture_has_alpha) {
    m.alpha_texture = m.diffuse_texture;
  }
  if (m.alpha_texture.used()) {
    m.alpha_cutoff = kCutoff;
    // The image defines the cut-out; an additional factor (often 0 by mistake) is ignored.
    m.opacity = 1.0F;
    return;
  }
  const bool is_blended = source.alpha == AlphaMode::blend;
  if ((is_blended && texture_has_alpha) ||
      (m.opacity < 1.0F && (is_blended || source.alpha == AlphaMode::factor))) {
    note_solid(model);
  }
}

void set_normals(const NamedTexture& named, TextureStore& textures, Material& m) {
  const TextureStore::NormalMap map = textures.normals(named.name);
  if (map.texture == TextureUse::kNone) return;
  m.normal_texture = named.use;
  m.normal_texture.texture = map.texture;
  const float scale = map.scale * named.bump.value_or(1.0F);
  m.normal_scale = std::isfinite(scale) ? scale : map.scale;
}

}  // namespace

Material make_material(const SourceMaterial& source, TextureStore& textures, Model& model) {
  Material m = source.material;
  m.diffuse_texture = colours_of(source.diffuse, textures);
  m.specular_texture = colours_of(source.specular, textures);
  set_cutout(source, textures, model, m);
  if (source.normals) set_normals(*source.normals, textures, m);
  return m;
}

}  // namespace glidar::import

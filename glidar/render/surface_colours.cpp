// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/surface_colours.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/surface.hpp>

namespace glidar {
namespace {

/// A scalar at the corners of sixteen triangles.
struct CornerValues {
  Lanes<float> at_0;
  Lanes<float> at_1;
  Lanes<float> at_2;
};

// Whole vectors are written, since vectors written in parts are slow to load.

/// Sets the same values at the corners for all lanes.
GLIDAR_SIMD void repeat_values(const std::array<float, 3>& at_corner, CornerValues& values) {
  fill(at_corner[0], values.at_0);
  fill(at_corner[1], values.at_1);
  fill(at_corner[2], values.at_2);
}

/// Collects a component of a vertex attribute at the corners of triangles; `is_one`: all are the
/// same.
template <class Vector>
void gather(const std::vector<Vector>& of_vertex, Eigen::Index component,
            const std::array<const Triangle*, kLanes>& triangles, bool is_one,
            CornerValues& values) {
  const auto at = [&](unsigned lane, std::size_t corner) {
    return of_vertex[(*triangles[lane])[corner]][component];
  };
  if (is_one) return repeat_values({at(0, 0), at(0, 1), at(0, 2)}, values);
  for (unsigned i = 0; i < kLanes; ++i) {
    values.at_0[i] = at(i, 0);
    values.at_1[i] = at(i, 1);
    values.at_2[i] = at(i, 2);
  }
}

GLIDAR_SIMD void interpolate(const CornerValues& c, const Lanes<float>& w1, const Lanes<float>& w2,
                             Lanes<float>& out) {
  for (unsigned i = 0; i < kLanes; ++i) {
    out[i] = (1.0F - w1[i] - w2[i]) * c.at_0[i] + w1[i] * c.at_1[i] + w2[i] * c.at_2[i];
  }
}

GLIDAR_SIMD void set_white(Lanes3<float>& rgb) {
  fill(1.0F, rgb.x);
  fill(1.0F, rgb.y);
  fill(1.0F, rgb.z);
}

GLIDAR_SIMD void multiply(const Lanes3<float>& by, Lanes3<float>& rgb) {
  for (unsigned i = 0; i < kLanes; ++i) rgb.x[i] *= by.x[i];
  for (unsigned i = 0; i < kLanes; ++i) rgb.y[i] *= by.y[i];
  for (unsigned i = 0; i < kLanes; ++i) rgb.z[i] *= by.z[i];
}

/// Luminances of a colour times tints.
GLIDAR_SIMD void luminances(const Eigen::Vector3f& colour, const Lanes3<float>& tint,
                            Lanes<float>& out) {
  const float red = colour.x();
  const float green = colour.y();
  const float blue = colour.z();
  for (unsigned i = 0; i < kLanes; ++i) {
    out[i] = 0.2126F * (red * tint.x[i]) + 0.7152F * (green * tint.y[i]) +
             0.0722F * (blue * tint.z[i]);  // as luminance()
  }
}

/// Writes a value to the beams of these lanes.
template <class T>
void write_same(const HitBlock& block, std::uint32_t lanes, const T& value,
                std::vector<T>& column) {
  const auto same = [value](unsigned /*lane*/) { return value; };
  write_lanes(block, lanes, same, column);
}

bool has_tint(const Material& material, const Mesh& mesh) {
  return material.diffuse_texture.used() || !mesh.colours.empty();
}

}  // namespace

SurfaceColours::SurfaceColours(const Scene& scene) : scene_(scene) {
  slots_.reserve(scene.instances.size());
  textures_.resize(scene.textures.size());
  const auto prepare = [&](const TextureUse& use) {
    if (!use.used()) return;
    const auto index = static_cast<std::size_t>(use.texture);
    if (textures_[index].is_empty()) textures_[index] = LookupTexture(scene.textures[index]);
  };
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const std::vector<std::uint16_t>& of_triangle = mesh.material_slots;
    Slots& slots = slots_.emplace_back();
    slots.of_triangle = of_triangle.empty() ? nullptr : of_triangle.data();
    for (const std::uint32_t index : instance.materials) {
      const Material& material = scene.materials[index];
      slots.all.push_back({&mesh,
                           &material,
                           {.diffuse = luminance(material.diffuse),
                            .ambient = luminance(material.ambient),
                            .specular = luminance(material.specular),
                            .shininess = material.shininess},
                           has_tint(material, mesh)});
      prepare(material.diffuse_texture);
      prepare(material.specular_texture);
    }
  }
}

bool SurfaceColours::has_one_slot(const HitBlock& block) const {
  return is_one_instance(block) && slots_[block.instance[0]].of_triangle == nullptr;
}

const SurfaceColours::Slot& SurfaceColours::slot_of(std::uint32_t instance,
                                                    std::uint32_t primitive) const {
  const Slots& slots = slots_[instance];
  return slots.all[slots.of_triangle == nullptr ? 0 : slots.of_triangle[primitive]];
}

void SurfaceColours::write(const HitColumnMask& hit_columns, const HitBlock& block,
                           const Lanes<float>& w1, const Lanes<float>& w2, Hits& hits) const {
  if (block.is_one_triangle || has_one_slot(block)) {
    const auto first = static_cast<unsigned>(std::countr_zero(block.mask));
    const Slot& slot = slot_of(block.instance[first], block.primitive[first]);
    return write(hit_columns, {slot, block.mask, block, w1, w2}, hits);
  }
  std::array<const Slot*, kLanes> slots{};
  for_lanes(block.mask,
            [&](unsigned i) { slots[i] = &slot_of(block.instance[i], block.primitive[i]); });
  for (std::uint32_t rest = block.mask; rest != 0;) {
    const Slot* slot = slots[static_cast<unsigned>(std::countr_zero(rest))];
    std::uint32_t lanes = 0;
    for (unsigned i = 0; i < kLanes; ++i) {
      lanes |= static_cast<std::uint32_t>(slots[i] == slot) << i;
    }
    write(hit_columns, {*slot, lanes, block, w1, w2}, hits);
    rest &= ~lanes;
  }
}

void SurfaceColours::write(const HitColumnMask& hit_columns, const Group& group, Hits& hits) const {
  const Slot& slot = group.slot;
  if (hit_columns.noise_scale) write_noise_scale(group, hits);
  if (slot.has_tint || slot.material->specular_texture.used()) {
    return write_tinted(hit_columns, group, hits);
  }
  if (hit_columns.diffuse) write_same(group.block, group.lanes, slot.plain.diffuse, hits.diffuse);
  if (hit_columns.colour) write_same(group.block, group.lanes, slot.material->diffuse, hits.colour);
  if (hit_columns.reflectance) write_same(group.block, group.lanes, slot.plain, hits.reflectance);
}

void SurfaceColours::write_tinted(const HitColumnMask& hit_columns, const Group& group,
                                  Hits& hits) const {
  if (!hit_columns.diffuse && !hit_columns.colour && !hit_columns.reflectance) return;
  const Material& material = *group.slot.material;
  Lanes3<float> tint;
  set_white(tint);
  multiply_by_texture(group, material.diffuse_texture, tint);
  multiply_by_vertex_colours(group, tint);
  Lanes<float> diffuse;
  luminances(material.diffuse, tint, diffuse);
  if (hit_columns.diffuse) {
    const auto value = [&](unsigned i) { return diffuse[i]; };
    write_lanes(group.block, group.lanes, value, hits.diffuse);
  }
  if (hit_columns.colour) {
    for_lanes(group.lanes, [&](unsigned i) {
      hits.colour[group.block.beam[i]] = material.diffuse.cwiseProduct(tint.get(i));
    });
  }
  if (!hit_columns.reflectance) return;
  Lanes3<float> gloss;
  set_white(gloss);
  multiply_by_texture(group, material.specular_texture, gloss);
  Lanes<float> ambient;
  Lanes<float> specular;
  luminances(material.ambient, tint, ambient);
  luminances(material.specular, gloss, specular);
  const auto reflectance = [&](unsigned i) {
    return Reflectance{diffuse[i], ambient[i], specular[i], material.shininess};
  };
  write_lanes(group.block, group.lanes, reflectance, hits.reflectance);
}

void SurfaceColours::write_noise_scale(const Group& group, Hits& hits) const {
  const Material& material = *group.slot.material;
  const HitBlock& block = group.block;
  if (!material.noise_texture.used()) {
    write_same(block, group.lanes, material.noise_scale, hits.noise_scale);
    return;
  }
  for_lanes(group.lanes, [&](unsigned i) {
    const SurfacePoint surface_point{*group.slot.mesh,
                                     scene_.instances[block.instance[i]],
                                     block.primitive[i],
                                     {group.w1[i], group.w2[i]}};
    hits.noise_scale[block.beam[i]] = noise_scale_at(
        material, scene_.textures, uv_at(surface_point, material.noise_texture.uv_set));
  });
}

std::array<const Triangle*, kLanes> SurfaceColours::triangles_of(const Group& group) {
  const auto first = static_cast<unsigned>(std::countr_zero(group.lanes));
  std::array<const Triangle*, kLanes> triangles;
  for (unsigned i = 0; i < kLanes; ++i) {
    const unsigned lane = (group.lanes >> i & 1U) != 0 ? i : first;
    triangles[i] = &group.slot.mesh->triangles[group.block.primitive[lane]];
  }
  return triangles;
}

void SurfaceColours::multiply_by_texture(const Group& group, const TextureUse& use,
                                         Lanes3<float>& rgb) const {
  if (!use.used()) return;
  const std::vector<Eigen::Vector2f>& uvs = group.slot.mesh->uvs[use.uv_set];
  Lanes<float> u{};
  Lanes<float> v{};
  if (!uvs.empty()) {
    const std::array<const Triangle*, kLanes> triangles = triangles_of(group);
    CornerValues values;
    gather(uvs, 0, triangles, group.block.is_one_triangle, values);
    interpolate(values, group.w1, group.w2, u);
    gather(uvs, 1, triangles, group.block.is_one_triangle, values);
    interpolate(values, group.w1, group.w2, v);
  }
  Lanes3<float> texels;
  textures_[static_cast<std::size_t>(use.texture)].sample(use, u, v, texels);
  multiply(texels, rgb);
}

void SurfaceColours::multiply_by_vertex_colours(const Group& group, Lanes3<float>& rgb) {
  const std::vector<Eigen::Vector3f>& colours = group.slot.mesh->colours;
  if (colours.empty()) return;
  const std::array<const Triangle*, kLanes> triangles = triangles_of(group);
  Lanes3<float> blended;
  Lanes<float>* components[] = {&blended.x, &blended.y, &blended.z};
  for (Eigen::Index k = 0; k < 3; ++k) {
    CornerValues values;
    gather(colours, k, triangles, group.block.is_one_triangle, values);
    interpolate(values, group.w1, group.w2, *components[k]);
  }
  multiply(blended, rgb);
}

}  // namespace glidar

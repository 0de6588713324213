// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/core/material.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/render/hit_block.hpp>
#include <glidar/render/lanes.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace glidar {

/// A point on a mesh: a triangle and the barycentric weights of its corners 1 and 2.
struct SurfacePoint {
  const Mesh& mesh;
  const Instance& instance;
  std::uint32_t triangle;
  Eigen::Vector2f weights;
};

/// The material at a point.
const Material& material_at(const Scene& scene, const SurfacePoint& surface_point);

/// The texture coordinate at a point; zero where the mesh has none.
Eigen::Vector2f uv_at(const SurfacePoint& surface_point, std::uint8_t uv_set);

/// True when the material's alpha mask is transparent at the point.
bool is_cut_out(const Scene& scene, const SurfacePoint& surface_point);

/// True when the material has a normal map that applies to the mesh.
bool has_normal_map(const Material& material, const Mesh& mesh);

/// The unit normal `smooth` after the material's normal map, in the object frame on the front side.
Eigen::Vector3f apply_normal_map(const Scene& scene, const SurfacePoint& surface_point,
                                 const Eigen::Vector3f& smooth);

/// The colours of a texture, stored for fast access: four bytes per texel, in tiles of 4x4
/// texels, one per cache line. The four texels around a point, and those of neighbouring hits, are
/// then mostly close together in memory.
class LookupTexture {
 public:
  LookupTexture() = default;
  explicit LookupTexture(const Texture& texture);

  [[nodiscard]] bool is_empty() const { return texels_.empty(); }

  /// The rgb at sixteen texture coordinates, bit-identical to sample().
  void sample(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
              Lanes3<float>& rgb) const;

 private:
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  std::uint32_t tile_columns_ = 0;
  std::vector<std::uint32_t> texels_;  ///< red in the lowest byte, then green and blue
};

/// The colours of equation (5) and the scale of random errors at hits: those of the material times
/// those of textures and vertex colours.
class SurfaceColours {
 public:
  /// The scene must outlive this.
  explicit SurfaceColours(const Scene& scene);

  /// True when some of the columns are written by write().
  static bool needed(const HitColumnMask& hit_columns) {
    return hit_columns.diffuse || hit_columns.colour || hit_columns.reflectance ||
           hit_columns.noise_scale;
  }

  /// Writes the columns for the hits of a block; w1 and w2 are the barycentric weights of corners 1
  /// and 2.
  void write(const HitColumnMask& hit_columns, const HitBlock& block, const Lanes<float>& w1,
             const Lanes<float>& w2, Hits& hits) const;

 private:
  /// A material of one instance.
  struct Slot {
    const Mesh* mesh;
    const Material* material;
    Reflectance plain;  ///< without textures
    bool has_tint;      ///< a texture or vertex colours change the diffuse colour
  };
  /// The slots of an instance.
  struct Slots {
    const std::uint16_t* of_triangle;  ///< nullptr: all triangles have slot 0
    std::vector<Slot> all;
  };
  /// Hits of one slot.
  struct Group {
    const Slot& slot;
    std::uint32_t lanes;
    const HitBlock& block;
    const Lanes<float>& w1;
    const Lanes<float>& w2;
  };

  /// True when all lanes, also those of misses, have the same slot.
  [[nodiscard]] bool has_one_slot(const HitBlock& block) const;
  [[nodiscard]] const Slot& slot_of(std::uint32_t instance, std::uint32_t primitive) const;
  void write(const HitColumnMask& hit_columns, const Group& group, Hits& hits) const;
  void write_tinted(const HitColumnMask& hit_columns, const Group& group, Hits& hits) const;
  void write_noise_scale(const Group& group, Hits& hits) const;
  static std::array<const Triangle*, kLanes> triangles_of(const Group& group);
  void multiply_by_texture(const Group& group, const TextureUse& use, Lanes3<float>& rgb) const;
  static void multiply_by_vertex_colours(const Group& group, Lanes3<float>& rgb);

  const Scene& scene_;
  std::vector<Slots> slots_;             ///< per instance
  std::vector<LookupTexture> textures_;  ///< per texture of the scene; empty: not used for colours
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/surface.hpp>

#include <glidar/math/simd.hpp>

#include <cmath>

namespace glidar {
namespace {

/// A per-vertex attribute interpolated over the triangle.
template <class Vector>
Vector interpolate(const std::vector<Vector>& values, const SurfacePoint& surface_point) {
  const Triangle& corners = surface_point.mesh.triangles[surface_point.triangle];
  const float w1 = surface_point.weights.x();
  const float w2 = surface_point.weights.y();
  return (1.0F - w1 - w2) * values[corners[0]] + w1 * values[corners[1]] + w2 * values[corners[2]];
}

/// The texel of a material's texture at a point; white when the texture is not used.
Eigen::Vector4f texel_at(const Scene& scene, const SurfacePoint& surface_point,
                         const TextureUse& use) {
  if (!use.used()) return Eigen::Vector4f::Ones();
  return sample(use, scene.textures, uv_at(surface_point, use.uv_set));
}

}  // namespace

const Material& material_at(const Scene& scene, const SurfacePoint& surface_point) {
  return material_of(scene, surface_point.instance, surface_point.triangle);
}

Eigen::Vector2f uv_at(const SurfacePoint& surface_point, std::uint8_t uv_set) {
  const std::vector<Eigen::Vector2f>& uvs = surface_point.mesh.uvs[uv_set];
  return uvs.empty() ? Eigen::Vector2f::Zero() : interpolate(uvs, surface_point);
}

bool is_cut_out(const Scene& scene, const SurfacePoint& surface_point) {
  const Material& material = material_at(scene, surface_point);
  if (!(material.alpha_cutoff > 0.0F)) return false;
  const Eigen::Vector2f uv = uv_at(surface_point, material.alpha_texture.uv_set);
  return opacity_at(material, scene.textures, uv) < material.alpha_cutoff;
}

bool has_normal_map(const Material& material, const Mesh& mesh) {
  return material.normal_texture.used() && !mesh.tangents.empty();
}

Eigen::Vector3f apply_normal_map(const Scene& scene, const SurfacePoint& surface_point,
                                 const Eigen::Vector3f& smooth) {
  const Material& material = material_at(scene, surface_point);
  const Eigen::Vector4f tangent4 = interpolate(surface_point.mesh.tangents, surface_point);
  const Eigen::Vector3f raw = tangent4.head<3>();
  const Eigen::Vector3f along = raw - smooth * smooth.dot(raw);
  const float length = along.norm();
  constexpr float kShortest = 1e-6F;  // below it the direction of +u is not defined here
  if (!(length > kShortest)) return smooth;
  const Eigen::Vector3f tangent = along / length;
  const float sign = tangent4.w() < 0.0F ? -1.0F : 1.0F;
  const Eigen::Vector3f bitangent = sign * smooth.cross(tangent);
  const Eigen::Vector3f rgb = texel_at(scene, surface_point, material.normal_texture).head<3>();
  const Eigen::Vector3f local = 2.0F * rgb - Eigen::Vector3f::Ones();  // n = 2 rgb - 1
  const Eigen::Vector3f normal = tangent * (local.x() * material.normal_scale) +
                                 bitangent * (local.y() * material.normal_scale) +
                                 smooth * local.z();
  const float bent_length = normal.norm();
  return bent_length > kShortest ? Eigen::Vector3f(normal / bent_length) : smooth;
}

namespace {

constexpr std::uint32_t kTileShift = 2;  // tiles of 4x4 texels
constexpr std::uint32_t kTileMask = (1U << kTileShift) - 1U;

/// Index of a texel; tiles are stored row by row.
inline std::uint32_t tiled_index(std::uint32_t row, std::uint32_t column,
                                 std::uint32_t tile_columns) {
  const std::uint32_t tile = (row >> kTileShift) * tile_columns + (column >> kTileShift);
  return (tile << (2 * kTileShift)) | ((row & kTileMask) << kTileShift) | (column & kTileMask);
}

std::uint32_t rgb_of(const Texture& texture, std::size_t texel) {
  const std::uint8_t* bytes = &texture.texels[texel * texture.channels];
  const std::uint32_t red = bytes[0];
  if (texture.channels < 3) return red | red << 8U | red << 16U;  // grey
  return red | std::uint32_t{bytes[1]} << 8U | std::uint32_t{bytes[2]} << 16U;
}

/// Size and wrap mode of a texture along one axis.
struct Axis {
  double size;
  double period;  ///< of repeat and mirror
  double per_period;
  bool clamps;

  Axis(std::uint32_t texels, Wrap wrap)
      : size(texels),
        period(wrap == Wrap::mirror ? 2.0 * size : size),
        per_period(1.0 / period),
        clamps(wrap == Wrap::clamp) {}

  /// An integer coordinate modulo the period. The quotient is below 2^50, so that its two roundings
  /// change it by at most 1/4 and its floor by at most one; all other operations are exact.
  [[nodiscard]] inline double rest_of(double index) const {
    double rest = index - std::floor(index * per_period) * period;
    rest = rest < 0.0 ? rest + period : rest;
    return rest >= period ? rest - period : rest;
  }

  /// The rest of the next coordinate.
  [[nodiscard]] inline double next_rest(double rest) const {
    return rest + 1.0 >= period ? rest + 1.0 - period : rest + 1.0;
  }

  /// The texel of an integer coordinate.
  [[nodiscard]] inline std::int32_t texel(double index, double rest) const {
    const double mirrored = rest >= size ? period - 1.0 - rest : rest;
    const double not_below = index > 0.0 ? index : 0.0;
    const double clamped = not_below < size - 1.0 ? not_below : size - 1.0;
    return static_cast<std::int32_t>(clamps ? clamped : mirrored);
  }
};

/// Texel coordinates, see sample(): whole and fractional parts.
struct TexelPosition {
  Lanes<double> first;
  Lanes<float> rest;
};

/// One row of TextureUse's transform of texture coordinates.
struct Transform {
  float at_u;
  float at_v;
  float offset;

  [[nodiscard]] inline float of(float u, float v) const { return at_u * u + at_v * v + offset; }
};

inline double clamped(double x) {
  constexpr double kFar = 1e15;  // as sample()
  const double above = x > -kFar ? x : -kFar;
  return above < kFar ? above : kFar;
}

/// Splits coordinates along an axis; `at`: finite, 1 at the end of the texture.
GLIDAR_SIMD void find_texels(const Lanes<double>& at, double size, bool is_nearest,
                             TexelPosition& position) {
  const double half = is_nearest ? 0.0 : 0.5;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double x = clamped(at[i] * size) - half;
    const double first = std::floor(x);
    position.first[i] = first;
    position.rest[i] = is_nearest ? 0.0F : static_cast<float>(x - first);
  }
}

/// Two adjacent texels along an axis.
struct TexelPair {
  Lanes<std::int32_t> first;
  Lanes<std::int32_t> next;
};

GLIDAR_SIMD void wrap(const Axis& axis, const Lanes<double>& first, TexelPair& texels) {
  const Axis a = axis;  // a copy, so that the loop vectorises
  for (unsigned i = 0; i < kLanes; ++i) {
    const double rest = a.rest_of(first[i]);
    texels.first[i] = a.texel(first[i], rest);
    texels.next[i] = a.texel(first[i] + 1.0, a.next_rest(rest));
  }
}

/// byte / 255, correctly rounded without a division: the first product is exact, and the second one
/// too small for its rounding to matter.
constexpr float part_of(std::uint32_t byte) {
  const auto whole = static_cast<float>(static_cast<std::int32_t>(byte));
  return whole * 0x1.01p-8F + whole * 0x1.0101p-24F;
}

constexpr bool are_parts_exact() {
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    if (part_of(byte) != static_cast<float>(byte) / 255.0F) return false;
  }
  return true;
}
static_assert(are_parts_exact());

/// Texture coordinates after TextureUse's transform, v downwards. Non-finite ones become 0 and are
/// marked.
GLIDAR_SIMD void transform(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
                           Lanes<double>& x, Lanes<double>& y, Lanes<std::int32_t>& is_finite) {
  const Transform to_x{use.uv_scale_rotate(0, 0), use.uv_scale_rotate(0, 1), use.uv_offset.x()};
  const Transform to_y{use.uv_scale_rotate(1, 0), use.uv_scale_rotate(1, 1), use.uv_offset.y()};
  for (unsigned i = 0; i < kLanes; ++i) {
    const float at_x = to_x.of(u[i], v[i]);
    const float at_y = to_y.of(u[i], v[i]);
    const float sum = (at_x - at_x) + (at_y - at_y);  // 0 only of finite numbers
    const bool finite = sum == 0.0F;
    is_finite[i] = finite ? 1 : 0;
    x[i] = finite ? static_cast<double>(at_x) : 0.0;
    y[i] = finite ? 1.0 - static_cast<double>(at_y) : 0.0;
  }
}

GLIDAR_SIMD void load(const std::uint32_t* texels, std::uint32_t tile_columns,
                      const Lanes<std::int32_t>& row, const Lanes<std::int32_t>& column,
                      Lanes3<float>& rgb) {
  Lanes<std::uint32_t> texel;
  for (unsigned i = 0; i < kLanes; ++i) {
    texel[i] = texels[tiled_index(static_cast<std::uint32_t>(row[i]),
                                  static_cast<std::uint32_t>(column[i]), tile_columns)];
  }
  for (unsigned i = 0; i < kLanes; ++i) rgb.x[i] = part_of(texel[i] & 0xFFU);
  for (unsigned i = 0; i < kLanes; ++i) rgb.y[i] = part_of(texel[i] >> 8U & 0xFFU);
  for (unsigned i = 0; i < kLanes; ++i) rgb.z[i] = part_of(texel[i] >> 16U & 0xFFU);
}

/// a = (1 - t) a + t b
GLIDAR_SIMD void blend(const Lanes<float>& t, const Lanes3<float>& b, Lanes3<float>& a) {
  for (unsigned i = 0; i < kLanes; ++i) a.x[i] = (1.0F - t[i]) * a.x[i] + t[i] * b.x[i];
  for (unsigned i = 0; i < kLanes; ++i) a.y[i] = (1.0F - t[i]) * a.y[i] + t[i] * b.y[i];
  for (unsigned i = 0; i < kLanes; ++i) a.z[i] = (1.0F - t[i]) * a.z[i] + t[i] * b.z[i];
}

void whiten(const Lanes<std::int32_t>& is_finite, Lanes3<float>& rgb) {
  for (unsigned i = 0; i < kLanes; ++i) {
    if (is_finite[i] == 0) rgb.set(i, Eigen::Vector3f::Ones());
  }
}

}  // namespace

LookupTexture::LookupTexture(const Texture& texture)
    : width_(texture.width),
      height_(texture.height),
      tile_columns_((texture.width + kTileMask) >> kTileShift) {
  const std::size_t tile_rows = (height_ + kTileMask) >> kTileShift;
  texels_.resize(tile_rows * tile_columns_ << (2 * kTileShift));
  for (std::uint32_t row = 0; row < height_; ++row) {
    for (std::uint32_t column = 0; column < width_; ++column) {
      texels_[tiled_index(row, column, tile_columns_)] =
          rgb_of(texture, std::size_t{row} * width_ + column);
    }
  }
}

void LookupTexture::sample(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
                           Lanes3<float>& rgb) const {
  const bool is_nearest = use.filter == Filter::nearest;
  const Axis columns(width_, use.wrap_u);
  const Axis rows(height_, use.wrap_v);
  const auto fetch = [&](const Lanes<std::int32_t>& at_row, const Lanes<std::int32_t>& at_column,
                         Lanes3<float>& out) {
    load(texels_.data(), tile_columns_, at_row, at_column, out);
  };
  Lanes<double> x;
  Lanes<double> y;
  Lanes<std::int32_t> is_finite;
  transform(use, u, v, x, y, is_finite);
  TexelPosition across;
  TexelPosition down;
  find_texels(x, columns.size, is_nearest, across);
  find_texels(y, rows.size, is_nearest, down);
  TexelPair column;
  TexelPair row;
  wrap(columns, across.first, column);
  wrap(rows, down.first, row);
  fetch(row.first, column.first, rgb);
  if (!is_nearest) {
    Lanes3<float> other;
    Lanes3<float> lower;
    fetch(row.first, column.next, other);
    blend(across.rest, other, rgb);
    fetch(row.next, column.first, lower);
    fetch(row.next, column.next, other);
    blend(across.rest, other, lower);
    blend(down.rest, lower, rgb);
  }
  whiten(is_finite, rgb);
}

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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/material.hpp>

#include <glidar/core/field_visitor.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

constexpr NumberRule kLobeWidth = {0.0, 180.0, true, "degrees above 0 and below 180"};

}  // namespace

void describe(Lambert& /*lambert*/, FieldVisitor& /*visitor*/) {}

void describe(PhongLike& phong, FieldVisitor& visitor) {
  visitor.number({"specular_fraction", "share of the lobe"}, kZeroToOne, phong.specular_fraction);
  visitor.number({"exponent", "of the lobe"}, kFromZero, phong.exponent);
}

void describe(OrenNayar& oren_nayar, FieldVisitor& visitor) {
  visitor.number({"roughness_deg", "standard deviation of the facets' slopes", kUnitDegree},
                 {0.0, 90.0, false, "degrees from 0 to 90"}, oren_nayar.roughness_rad);
}

void describe(RetroReflector& retro, FieldVisitor& visitor) {
  visitor.number({"gain", "relative to a white diffuse surface"}, kAboveZero, retro.gain);
  visitor.number({"width_deg", "of the lobe", kUnitDegree}, kLobeWidth, retro.width_rad);
}

void describe(Glossy& glossy, FieldVisitor& visitor) {
  visitor.number({"diffuse_fraction", "share of the diffuse part"}, kZeroToOne,
                 glossy.diffuse_fraction);
  visitor.number({"lobe_gain", "middle of the lobe relative to a white diffuse surface"}, kFromZero,
                 glossy.lobe_gain);
  visitor.number({"width_deg", "standard deviation of the lobe", kUnitDegree}, kLobeWidth,
                 glossy.width_rad);
}

void describe(Brdf& brdf, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "the form of the backscatter", kNoUnit, kRequired}, brdf);
}

namespace {

/// The largest integer <= x, for |x| < 2^63.
std::int64_t floor_of(double x) {
  const auto towards_zero = static_cast<std::int64_t>(x);
  return towards_zero - static_cast<std::int64_t>(static_cast<double>(towards_zero) > x);
}

std::uint32_t wrap_beyond(std::int64_t index, std::int64_t size, Wrap wrap) {
  if (wrap == Wrap::clamp)
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, size - 1));
  const std::int64_t period = wrap == Wrap::repeat ? size : 2 * size;
  std::int64_t i = index % period;
  if (i < 0) i += period;
  if (i >= size) i = period - 1 - i;
  return static_cast<std::uint32_t>(i);
}

/// Texel index for any integer coordinate under a wrap mode. Most coordinates are inside, where no
/// division is needed.
std::uint32_t wrapped(std::int64_t index, std::uint32_t size, Wrap wrap) {
  const bool is_inside = static_cast<std::uint64_t>(index) < size;
  return is_inside ? static_cast<std::uint32_t>(index) : wrap_beyond(index, size, wrap);
}

/// byte / 255 for every byte: a lookup is faster than a division.
constexpr std::array<float, 256> kPartOf255 = [] {
  std::array<float, 256> parts{};
  for (std::size_t byte = 0; byte < parts.size(); ++byte) {
    parts[byte] = static_cast<float>(byte) / 255.0F;
  }
  return parts;
}();

Eigen::Vector4f texel(const Texture& texture, std::uint32_t row, std::uint32_t column) {
  const std::uint8_t* bytes =
      &texture.texels[(std::size_t{row} * texture.width + column) * texture.channels];
  const auto value = [&](std::size_t channel) { return kPartOf255[bytes[channel]]; };
  switch (texture.channels) {
    case 1:
      return {value(0), value(0), value(0), 1.0F};
    case 2:
      return {value(0), value(0), value(0), value(1)};
    case 3:
      return {value(0), value(1), value(2), 1.0F};
    default:
      return {value(0), value(1), value(2), value(3)};
  }
}

/// Alpha if the texture has it, else grey or red; 1 if the texture is not used.
float last_channel(const TextureUse& use, const std::vector<Texture>& textures,
                   const Eigen::Vector2f& uv) {
  if (!use.used()) return 1.0F;
  const std::uint32_t channels = textures[static_cast<std::size_t>(use.texture)].channels;
  const Eigen::Vector4f rgba = sample(use, textures, uv);
  return channels == 2 || channels == 4 ? rgba.w() : rgba.x();
}

}  // namespace

Eigen::Vector4f sample(const TextureUse& use, const std::vector<Texture>& textures,
                       const Eigen::Vector2f& uv) {
  if (!use.used()) return Eigen::Vector4f::Ones();
  const Texture& texture = textures[static_cast<std::size_t>(use.texture)];
  const Eigen::Vector2f at = use.uv_scale_rotate * uv + use.uv_offset;
  if (!at.allFinite()) return Eigen::Vector4f::Ones();
  // A double represents any float uv times any image size; texel centres are at half-integers.
  constexpr double kFar = 1e15;  // uvs beyond it have no fractional part left
  const double x = std::clamp(double{at.x()} * texture.width, -kFar, kFar);
  const double y = std::clamp((1.0 - double{at.y()}) * texture.height, -kFar, kFar);
  const auto row_of = [&](std::int64_t row) { return wrapped(row, texture.height, use.wrap_v); };
  const auto column_of = [&](std::int64_t column) {
    return wrapped(column, texture.width, use.wrap_u);
  };
  if (use.filter == Filter::nearest) {
    return texel(texture, row_of(floor_of(y)), column_of(floor_of(x)));
  }
  const std::int64_t left = floor_of(x - 0.5);
  const std::int64_t top = floor_of(y - 0.5);
  const auto fx = static_cast<float>(x - 0.5 - static_cast<double>(left));
  const auto fy = static_cast<float>(y - 0.5 - static_cast<double>(top));
  const std::uint32_t columns[] = {column_of(left), column_of(left + 1)};
  const auto blend_row = [&](std::uint32_t row) -> Eigen::Vector4f {
    return (1.0F - fx) * texel(texture, row, columns[0]) + fx * texel(texture, row, columns[1]);
  };
  const Eigen::Vector4f upper = blend_row(row_of(top));
  const Eigen::Vector4f lower = blend_row(row_of(top + 1));
  return (1.0F - fy) * upper + fy * lower;
}

float opacity_at(const Material& material, const std::vector<Texture>& textures,
                 const Eigen::Vector2f& uv) {
  return material.opacity * last_channel(material.alpha_texture, textures, uv);
}

float noise_scale_at(const Material& material, const std::vector<Texture>& textures,
                     const Eigen::Vector2f& uv) {
  return material.noise_scale * last_channel(material.noise_texture, textures, uv);
}

}  // namespace glidar

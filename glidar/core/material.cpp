// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/material.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// Texel index for any integer coordinate under a wrap mode.
std::uint32_t wrapped(std::int64_t index, std::uint32_t size, Wrap wrap) {
  const auto n = static_cast<std::int64_t>(size);
  if (wrap == Wrap::clamp)
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, n - 1));
  const std::int64_t period = wrap == Wrap::repeat ? n : 2 * n;
  std::int64_t i = index % period;
  if (i < 0) i += period;
  if (i >= n) i = period - 1 - i;
  return static_cast<std::uint32_t>(i);
}

Eigen::Vector4f texel(const Texture& texture, std::uint32_t row, std::uint32_t column) {
  const std::size_t first = (std::size_t{row} * texture.width + column) * texture.channels;
  const auto value = [&](std::size_t channel) {
    return static_cast<float>(texture.texels[first + channel]) / 255.0F;
  };
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

/// Alpha where the texture has it, else grey or red; 1 when it is not used.
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
  // Doubles hold any float uv times any image size; texel centres lie at half-integers.
  constexpr double kFar = 1e15;  // uvs beyond it have no fractional part left
  const double x = std::clamp(double{at.x()} * texture.width, -kFar, kFar);
  const double y = std::clamp((1.0 - double{at.y()}) * texture.height, -kFar, kFar);
  const auto fetch = [&](double row, double column) {
    return texel(texture, wrapped(static_cast<std::int64_t>(row), texture.height, use.wrap_v),
                 wrapped(static_cast<std::int64_t>(column), texture.width, use.wrap_u));
  };
  if (use.filter == Filter::nearest) return fetch(std::floor(y), std::floor(x));
  const double left = std::floor(x - 0.5);
  const double top = std::floor(y - 0.5);
  const auto fx = static_cast<float>(x - 0.5 - left);
  const auto fy = static_cast<float>(y - 0.5 - top);
  const Eigen::Vector4f upper = (1.0F - fx) * fetch(top, left) + fx * fetch(top, left + 1.0);
  const Eigen::Vector4f lower =
      (1.0F - fx) * fetch(top + 1.0, left) + fx * fetch(top + 1.0, left + 1.0);
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

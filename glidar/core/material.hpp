// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/brdf.hpp>
#include <glidar/math/lookup_table.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// A decoded image. Row 0 is the top row; `texels` has height x width x channels bytes.
struct Texture {
  std::string name;  ///< the file it came from, as the model names it
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;  ///< 1 grey, 2 grey+alpha, 3 rgb, 4 rgba
  std::vector<std::uint8_t> texels;
};

enum class Wrap : std::uint8_t { repeat, mirror, clamp };
enum class Filter : std::uint8_t { linear, nearest };

/// How a material uses a texture. The texture is sampled at `uv_scale_rotate * uv + uv_offset`,
/// with v upwards (row = (1 - v) * height).
struct TextureUse {
  static constexpr std::int32_t kNone = -1;
  std::int32_t texture = kNone;  ///< index into Scene::textures, kNone: not used
  std::uint8_t uv_set = 0;       ///< 0 or 1
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  Filter filter = Filter::linear;
  Eigen::Matrix2f uv_scale_rotate = Eigen::Matrix2f::Identity();
  Eigen::Vector2f uv_offset = Eigen::Vector2f::Zero();

  [[nodiscard]] bool used() const { return texture != kNone; }
};

/// Surface properties of the Phong model (2016 paper, equation 5). Colours are rgb 0..1 as stored
/// in the file (no gamma is applied, as in fixed-function OpenGL). A texture multiplies its colour.
struct Material {
  std::string name = "default";
  Eigen::Vector3f ambient =
      Eigen::Vector3f::Constant(0.8F);  ///< multiplied by the diffuse texture too
  Eigen::Vector3f diffuse = Eigen::Vector3f::Constant(0.8F);
  Eigen::Vector3f specular = Eigen::Vector3f::Zero();
  float shininess = 0.0F;     ///< exponent s of equation 5, 0..128
  float opacity = 1.0F;       ///< multiplied by the alpha texture
  float alpha_cutoff = 0.0F;  ///< rays pass where the opacity is below it; 0: solid
  Brdf backscatter;           ///< for pulsed sensors, with the reflectance of `spectrum`
  float mirror = 0.0F;        ///< share of a pulse that is reflected specularly, 0..1
  LookupTable spectrum;       ///< wavelength in m, reflectance 0..1; empty: the luminance of
                              ///< `diffuse`
  float noise_scale = 1.0F;   ///< multiplies random errors of sensors; times the noise texture
  float normal_scale = 1.0F;  ///< strength of the normal map's x and y
  TextureUse diffuse_texture;
  TextureUse specular_texture;
  TextureUse alpha_texture;   ///< last channel of the texture (alpha, or grey) is the opacity
  TextureUse normal_texture;  ///< tangent-space normals, n = 2 rgb - 1 (height maps are converted
                              ///< on loading)
  TextureUse noise_texture;   ///< last channel of the texture (alpha, or grey), 0..1
};

/// Luminance of an rgb colour, with the weights of Rec. ITU-R BT.709.
inline float luminance(const Eigen::Vector3f& rgb) {
  return 0.2126F * rgb.x() + 0.7152F * rgb.y() + 0.0722F * rgb.z();
}

/// The texture's rgba at a uv, 0..1: grey is copied to rgb, a missing alpha is 1. White if the
/// texture is not used.
Eigen::Vector4f sample(const TextureUse& use, const std::vector<Texture>& textures,
                       const Eigen::Vector2f& uv);

/// Material::noise_scale times the last channel of its noise texture at a uv.
float noise_scale_at(const Material& material, const std::vector<Texture>& textures,
                     const Eigen::Vector2f& uv);

/// Opacity of the material at a uv: Material::opacity times the last channel of its alpha texture.
float opacity_at(const Material& material, const std::vector<Texture>& textures,
                 const Eigen::Vector2f& uv);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/math/lookup_table.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

class FieldVisitor;

// Monostatic reflection (transmitter and receiver coincide) as a function of the incidence angle,
// relative to a white Lambertian surface at normal incidence. sensor/lidar/lidar_equation.hpp
// evaluates it.

/// A diffuse (Lambertian) surface: reflectance x cos(incidence).
struct Lambert {
  static constexpr TypeInfo kType = {"lambert", "cos(θ)"};
};

/// Phong's model in the form of HELIOS++ (model/ImprovedEnergyModel): reflectance x
/// [(1 - specular_fraction) cos(incidence) + specular_fraction |cos(2 incidence)|^exponent].
struct PhongLike {
  static constexpr TypeInfo kType = {
      "phong", "(1 - specular_fraction) cos(θ) + specular_fraction |cos(2 θ)|^exponent",
      "HELIOS++, model/ImprovedEnergyModel"};
  double specular_fraction = 0.2;  ///< 0..1
  double exponent = 20.0;          ///< at least 0
};

/// Oren and Nayar, "Generalization of Lambert's reflectance model", SIGGRAPH 1994, with transmitter
/// and receiver at the same point: reflectance x [A cos + B sin^2],
/// A = 1 - 0.5 s^2 / (s^2 + 0.33), B = 0.45 s^2 / (s^2 + 0.09).
struct OrenNayar {
  static constexpr TypeInfo kType = {
      "oren_nayar", "A cos(θ) + B sin²(θ), with light source and receiver in one place",
      "Oren and Nayar, Generalization of Lambert's reflectance model, SIGGRAPH 1994"};
  double roughness_rad = 0.3;  ///< s, standard deviation of the facets' slopes, at least 0
};

/// A retro-reflector: reflectance x gain x exp(-(incidence / width)^2).
struct RetroReflector {
  static constexpr TypeInfo kType = {"retro", "gain exp(-(θ / width)²)"};
  double gain = 300.0;       ///< relative to a white diffuse surface, above 0
  double width_rad = 0.524;  ///< above 0
};

/// Glass, solar panels, foil: a weak diffuse part and a narrow lobe, reflectance x
/// [diffuse_fraction cos(incidence) + lobe_gain exp(-incidence^2 / (2 width^2))].
struct Glossy {
  static constexpr TypeInfo kType = {
      "glossy",
      "diffuse_fraction cos(θ) + lobe_gain exp(-θ² / (2 width²)): glass, solar panels, foil"};
  double diffuse_fraction = 0.05;  ///< diffuse share, 0..1
  double lobe_gain = 10.0;    ///< peak of the lobe relative to a white diffuse surface, at least 0
  double width_rad = 0.0524;  ///< above 0
};

using Brdf = std::variant<Lambert, PhongLike, OrenNayar, RetroReflector, Glossy>;

/// Keys of `backscatter` of materials: `type` and those of the form.
void describe(Brdf& brdf, FieldVisitor& visitor);
void describe(Lambert& lambert, FieldVisitor& visitor);
void describe(PhongLike& phong, FieldVisitor& visitor);
void describe(OrenNayar& oren_nayar, FieldVisitor& visitor);
void describe(RetroReflector& retro, FieldVisitor& visitor);
void describe(Glossy& glossy, FieldVisitor& visitor);

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

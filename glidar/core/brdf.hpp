// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <variant>

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

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/material_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/surface_presets.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr const char* kOfModel = "as in the model";

void visit_colour(FieldVisitor& visitor, const char* key, const char* text,
                  std::optional<Eigen::Vector3f>& colour) {
  Eigen::Vector3d rgb = colour.value_or(Eigen::Vector3f::Zero()).cast<double>();
  const FieldInfo field = {key, text, kNoUnit, false, kOfModel};
  const bool is_given = visitor.vector(field, kZeroToOne, colour.has_value(), rgb);
  if (visitor.is_reading() && is_given) colour = rgb.cast<float>();
}

void visit_factor(FieldVisitor& visitor, const FieldInfo& field, const NumberRule& rule,
                  std::optional<float>& factor) {
  if (visitor.is_writing() && !factor) return;
  double value = factor.value_or(0.0F);
  visitor.number(field, rule, value);
  if (visitor.is_reading() && visitor.has(field.key)) factor = static_cast<float>(value);
}

/// A surface preset; keys after it change parts of it.
void visit_surface(FieldVisitor& visitor, MaterialOverride& change) {
  if (visitor.is_writing()) return;
  std::string name;
  visitor.text({"surface",
                "surface preset that sets `backscatter` and `spectrum`, see `glidar "
                "sensors --surfaces`",
                kNoUnit, false, "none"},
               name);
  if (name.empty()) return;
  try {
    const SurfacePreset surface = find_surface(name, "");
    change.spectrum = surface.spectrum;
    change.backscatter = surface.backscatter;
  } catch (const Error& error) {
    visitor.reject("surface", error.parts().found, error.parts().allowed, error.parts().remedy);
  }
}

}  // namespace

void visit_spectrum(FieldVisitor& visitor, bool is_required, LookupTable& spectrum) {
  constexpr NumberRule kWavelength = {100.0, 20000.0, false, "nanometres from 100 to 20000"};
  visitor.table({"spectrum",
                 "pairs `[wavelength, reflectance]`, linear between them, constant "
                 "outside",
                 kUnitNanometre, is_required, "luminance of `diffuse`"},
                kWavelength, kZeroToOne, spectrum);
}

void describe(MaterialOverride& change, FieldVisitor& visitor) {
  if (visitor.is_reading()) change.where = visitor.where("");
  visit_colour(visitor, "ambient", "`[r, g, b]`: reflected ambient light", change.ambient);
  visit_colour(visitor, "diffuse", "`[r, g, b]`: diffuse colour", change.diffuse);
  visit_colour(visitor, "specular", "`[r, g, b]`: colour of highlights", change.specular);
  visit_factor(visitor, {"shininess", "exponent of highlights", kNoUnit, false, kOfModel},
               {0.0, 128.0, false, "a number from 0 to 128"}, change.shininess);
  visit_factor(visitor, {"opacity", "beams pass below 0.5", kNoUnit, false, kOfModel}, kZeroToOne,
               change.opacity);
  visit_factor(visitor,
               {"noise_scale", "factor of the sensor's random errors", kNoUnit, false, kOfModel},
               kFromZero, change.noise_scale);
  visitor.path({"noise_texture", "a PNG file whose last channel multiplies `noise_scale`", kNoUnit,
                false, "none"},
               change.noise_texture);
  if (visitor.is_reading()) change.where_noise_texture = visitor.where("noise_texture");
  visit_surface(visitor, change);
  visit_object(visitor,
               {"backscatter", "how the surface reflects pulses, see below", kNoUnit, false,
                "`{type: lambert}`"},
               change.backscatter);
  visit_factor(visitor,
               {"mirror", "share of a pulse that is reflected as by a mirror", kNoUnit, false, "0"},
               kZeroToOne, change.mirror);
  visit_spectrum(visitor, false, change.spectrum);
}

void sort_overrides(std::vector<MaterialOverride>& changes) {
  std::stable_partition(changes.begin(), changes.end(),
                        [](const MaterialOverride& change) { return change.material == "*"; });
}

}  // namespace glidar

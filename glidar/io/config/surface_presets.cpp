// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/surface_presets.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/material_keys.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/files/paths.hpp>

#include <algorithm>

namespace glidar {
namespace {

SurfacePreset read_surface(const std::string& name, const YamlField& field) {
  SurfacePreset surface{.name = name, .about = "", .spectrum = {}, .source = ""};
  read_struct(field, surface);
  return surface;
}

}  // namespace

void describe(SurfacePreset& surface, FieldVisitor& visitor) {
  visitor.text({"about", "one line about the surface", kNoUnit, kRequired}, surface.about);
  visit_spectrum(visitor, kRequired, surface.spectrum);
  visit_object(visitor, {"backscatter", "how the surface reflects pulses"}, surface.backscatter);
  visitor.text({"source", "where the numbers come from", kNoUnit, kRequired}, surface.source);
  visitor.provenance({"unverified", "keys whose numbers are not published"}, false);
  if (visitor.is_reading()) surface.verified = !visitor.has("unverified");
}

std::vector<SurfacePreset> load_surfaces() {
  const YamlField root = read_yaml(data_folder("materials", "GLIDAR_MATERIALS") / "surfaces.yaml");
  std::vector<SurfacePreset> surfaces;
  for (const auto& [name, field] : entries(root)) surfaces.push_back(read_surface(name, field));
  return surfaces;
}

SurfacePreset find_surface(const std::string& name, const std::string& where) {
  const std::vector<SurfacePreset> surfaces = load_surfaces();
  const auto at = std::find_if(surfaces.begin(), surfaces.end(),
                               [&](const SurfacePreset& surface) { return surface.name == name; });
  if (at != surfaces.end()) return *at;
  std::vector<std::string> names;
  std::string listed;
  for (const SurfacePreset& surface : surfaces) {
    names.push_back(surface.name);
    listed += (listed.empty() ? "" : ", ") + surface.name;
  }
  const std::string nearest = closest_match(name, names);
  throw Error(
      {where, "'" + excerpt(name) + "' is no surface preset", listed,
       nearest.empty() ? "see 'glidar sensors --surfaces'" : "did you mean '" + nearest + "'?"});
}

void apply_surface(const SurfacePreset& surface, Material& material) {
  material.spectrum = surface.spectrum;
  material.backscatter = surface.backscatter;
}

}  // namespace glidar

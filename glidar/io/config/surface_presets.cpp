// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/surface_presets.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/config/pulse_yaml.hpp>
#include <glidar/io/files/data_folder.hpp>

#include <algorithm>

namespace glidar {
namespace {

SurfacePreset read_surface(const std::string& name, const YamlField& field) {
  require_map(field, {"about", "spectrum", "backscatter", "source", "unverified"});
  SurfacePreset surface{.name = name,
                        .about = text(need(field, "about")),
                        .spectrum = read_spectrum(need(field, "spectrum")),
                        .source = text(need(field, "source"))};
  if (const auto form = find(field, "backscatter")) surface.backscatter = read_backscatter(*form);
  if (const auto unverified = find(field, "unverified")) {
    for (const YamlField& key : items(*unverified)) one_of(key, {"spectrum", "backscatter"});
    surface.verified = false;
  }
  return surface;
}

}  // namespace

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
      {where, "'" + excerpt(name) + "' is no surface that comes along", listed,
       nearest.empty() ? "see 'glidar sensors --surfaces'" : "did you mean '" + nearest + "'?"});
}

void apply_surface(const SurfacePreset& surface, Material& material) {
  material.spectrum = surface.spectrum;
  material.backscatter = surface.backscatter;
}

}  // namespace glidar

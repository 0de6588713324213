// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/surfaces.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/data_folder.hpp>
#include <glidar/io/pulse_yaml.hpp>

#include <algorithm>

namespace glidar {
namespace {

Surface read_surface(const std::string& name, const YamlField& field) {
  require_map(field, {"about", "spectrum", "backscatter", "source", "unverified"});
  Surface surface{.name = name,
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

std::vector<Surface> load_surfaces() {
  const YamlField root = read_yaml(data_folder("materials", "GLIDAR_MATERIALS") / "surfaces.yaml");
  std::vector<Surface> surfaces;
  for (const auto& [name, field] : entries(root)) surfaces.push_back(read_surface(name, field));
  return surfaces;
}

Surface find_surface(const std::string& name, const std::string& where) {
  const std::vector<Surface> surfaces = load_surfaces();
  const auto at = std::find_if(surfaces.begin(), surfaces.end(),
                               [&](const Surface& surface) { return surface.name == name; });
  if (at != surfaces.end()) return *at;
  std::vector<std::string> names;
  std::string listed;
  for (const Surface& surface : surfaces) {
    names.push_back(surface.name);
    listed += (listed.empty() ? "" : ", ") + surface.name;
  }
  const std::string nearest = nearest_word(name, names);
  throw Error(
      {where, "'" + excerpt(name) + "' is no surface that comes along", listed,
       nearest.empty() ? "see 'glidar sensors --surfaces'" : "did you mean '" + nearest + "'?"});
}

void apply_surface(const Surface& surface, Material& material) {
  material.spectrum = surface.spectrum;
  material.backscatter = surface.backscatter;
}

}  // namespace glidar

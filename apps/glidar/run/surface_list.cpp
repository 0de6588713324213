// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/surface_list.hpp>

#include <apps/glidar/run/printing.hpp>
#include <glidar/io/config/surface_presets.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

using SurfaceJson = nlohmann::ordered_json;

constexpr std::array kSurfaceWavelengths_nm = {850, 905, 1064, 1550};

std::array<double, kSurfaceWavelengths_nm.size()> reflectances(const SurfacePreset& surface) {
  std::array<double, kSurfaceWavelengths_nm.size()> values{};
  std::transform(kSurfaceWavelengths_nm.begin(), kSurfaceWavelengths_nm.end(), values.begin(),
                 [&](int nm) { return interpolate(surface.spectrum, nm * 1e-9); });
  return values;
}

SurfaceJson json_of(const SurfacePreset& surface) {
  SurfaceJson reflectance = SurfaceJson::object();
  const auto values = reflectances(surface);
  for (std::size_t k = 0; k < values.size(); ++k) {
    reflectance[std::to_string(kSurfaceWavelengths_nm[k])] = values[k];
  }
  return {{"name", surface.name},
          {"about", surface.about},
          {"reflectance_at_nm", reflectance},
          {"diffuse", std::holds_alternative<Lambert>(surface.backscatter)},
          {"source", surface.source},
          {"verified", surface.verified}};
}

void print_surfaces(const std::vector<SurfacePreset>& surfaces) {
  print("{:<16}", "name");
  for (const int nm : kSurfaceWavelengths_nm) print("{:>6} nm", nm);
  print("  {:<7}  {:<8}  {}\n", "form", "verified", "what it is");
  for (const SurfacePreset& surface : surfaces) {
    print("{:<16}", surface.name);
    for (const double reflectance : reflectances(surface)) print("{:>9.3f}", reflectance);
    const bool is_diffuse = std::holds_alternative<Lambert>(surface.backscatter);
    print("  {:<7}  {:<8}  {}\n", is_diffuse ? "diffuse" : "glossy",
          surface.verified ? "yes" : "no", surface.about);
  }
}

}  // namespace

void list_surfaces(bool as_json) {
  const std::vector<SurfacePreset> surfaces = load_surfaces();
  if (!as_json) {
    print_surfaces(surfaces);
    return;
  }
  SurfaceJson json = SurfaceJson::array();
  for (const SurfacePreset& surface : surfaces) json.push_back(json_of(surface));
  print_json(json);
}

}  // namespace glidar::app

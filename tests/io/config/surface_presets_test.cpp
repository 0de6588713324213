// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include "io/material_keys.hpp"
#include "io/yaml_files.hpp"

#include <numbers>

namespace glidar {
namespace {

/// Written down from the spectral libraries apart from the file, in percent.
struct Row {
  const char* name;
  std::array<double, 4> percent;  ///< at 850, 905, 1064 and 1550 nm
};

constexpr std::array kRows = std::to_array<Row>({
    {"asphalt", {26.9, 27.8, 30.2, 36.2}},
    {"deciduous_leaf", {54.9, 55.4, 56.9, 25.3}},
    {"conifer", {51.5, 51.5, 52.4, 18.8}},
    {"grass", {49.7, 50.9, 52.5, 24.3}},
    {"dry_grass", {56.6, 59.8, 65.0, 56.9}},
    {"pine_wood", {91.6, 91.8, 90.5, 56.5}},
    {"slate_shingle", {19.0, 18.9, 18.8, 17.3}},
    {"asphalt_shingle", {6.7, 7.0, 6.8, 7.0}},
    {"aluminium", {53.8, 59.6, 70.9, 81.3}},
    {"copper", {50.7, 54.5, 64.1, 78.1}},
    {"mli", {85.0, 85.0, 85.0, 85.0}},
    {"solar_cell", {9.0, 9.0, 9.0, 9.0}},
    {"white_paint", {80.0, 80.0, 80.0, 80.0}},
    {"black_paint", {5.0, 5.0, 5.0, 5.0}},
});

TEST(Surfaces, HaveTheReflectancesOfTheLibraries) {
  const std::vector<SurfacePreset> surfaces = load_surfaces();
  ASSERT_EQ(surfaces.size(), kRows.size());
  for (const Row& row : kRows) {
    Material material;
    apply_surface(find_surface(row.name, ""), material);
    EXPECT_NEAR(reflectance_at(material, 850e-9), 0.01 * row.percent[0], 1e-12) << row.name;
    EXPECT_NEAR(reflectance_at(material, 905e-9), 0.01 * row.percent[1], 1e-12) << row.name;
    EXPECT_NEAR(reflectance_at(material, 1064e-9), 0.01 * row.percent[2], 1e-12) << row.name;
    EXPECT_NEAR(reflectance_at(material, 1550e-9), 0.01 * row.percent[3], 1e-12) << row.name;
  }
}

TEST(Surfaces, TellTheirSource) {
  for (const SurfacePreset& surface : load_surfaces()) {
    EXPECT_FALSE(surface.source.empty());
    EXPECT_FALSE(surface.about.empty());
  }
  EXPECT_TRUE(find_surface("grass", "").verified);
  EXPECT_FALSE(find_surface("mli", "").verified);
}

/// Light sent into all directions over light received, at normal incidence: the diffuse part and a
/// narrow lobe of mirrored light, which turns by twice the angle of the facet.
double energy_of(const Glossy& form) {
  const double width_rad = 2.0 * form.width_rad;
  double lobe = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = (k + 0.5) / kSteps * 0.5 * std::numbers::pi;
    lobe += std::exp(-0.5 * std::pow(angle / width_rad, 2)) * std::sin(angle) * std::cos(angle);
  }
  // over a diffuse surface's radiance, 1 / pi: 2 pi / pi times the integral
  return form.diffuse_fraction + form.lobe_gain * 2.0 * lobe * 0.5 * std::numbers::pi / kSteps;
}

TEST(Surfaces, ThatAreGlossyKeepTheEnergy) {
  std::size_t glossy = 0;
  for (const SurfacePreset& surface : load_surfaces()) {
    const auto* form = std::get_if<Glossy>(&surface.backscatter);
    if (form == nullptr) continue;
    ++glossy;
    EXPECT_NEAR(energy_of(*form), 1.0, 0.05) << surface.name;
    EXPECT_GE(form->width_rad, 0.99 * kDegree);
    EXPECT_LE(form->width_rad, 5.01 * kDegree);
  }
  EXPECT_EQ(glossy, 4U);
}

TEST(SurfacesInASceneFile, GiveSpectrumAndBackscatter) {
  const Material foil = testing::material_of_keys("surface: mli");
  EXPECT_NEAR(reflectance_at(foil, 1064e-9), 0.85, 1e-12);
  EXPECT_NEAR(std::get<Glossy>(foil.backscatter).width_rad, 5.0 * kDegree, 1e-12);
  const Material road = testing::material_of_keys("surface: asphalt");
  EXPECT_TRUE(std::holds_alternative<Lambert>(road.backscatter));
  EXPECT_NEAR(reflectance_at(road, 905e-9), 0.278, 1e-12);
}

TEST(SurfacesInASceneFile, YieldToWhatIsToldBesideThem) {
  const Material painted = testing::material_of_keys("spectrum: [[905, 0.5]], surface: mli");
  EXPECT_EQ(reflectance_at(painted, 905e-9), 0.5);
  EXPECT_TRUE(std::holds_alternative<Glossy>(painted.backscatter));
  const Material matt = testing::material_of_keys("surface: mli, backscatter: {type: lambert}");
  EXPECT_TRUE(std::holds_alternative<Lambert>(matt.backscatter));
  EXPECT_NEAR(reflectance_at(matt, 905e-9), 0.85, 1e-12);
}

TEST(SurfacesInASceneFile, AreToldTheNearestNameWhenUnknown) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "models: [{model: builtin:box, materials: {\"*\": {surface: asfalt}}}]\n");
  const std::string error = error_of(folder, [&] { load_scene_file(file, {}, {}); });
  EXPECT_TRUE(
      error.starts_with("s.yaml:1:58: models[0].materials.*.surface: 'asfalt' is no surface "
                        "preset; allowed: asphalt, deciduous_leaf, conifer, "))
      << error;
  EXPECT_TRUE(error.ends_with("did you mean 'asphalt'?")) << error;
}

}  // namespace
}  // namespace glidar

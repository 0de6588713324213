// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <gtest/gtest.h>
#include <io/material_keys.hpp>
#include <io/yaml_files.hpp>

namespace glidar {
namespace {

const std::string kOptics = "optics: {width: 4, height: 2, fov_deg: 20}\n";

LidarEquation pulse(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kOptics + "lidar_equation: " + map + "\n"))
              .lidar_equation;
}

TEST(PulseLightInASensorFile, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kOptics)).lidar_equation.has_value());
}

TEST(PulseLightInASensorFile, GivesEveryNumber) {
  const LidarEquation light = pulse(
      "{reference_reflectance: 0.1, reference_range_m: 55, range_exponent: 2.6, overlap: "
      "[[0.9, 0], [1, 1]], extinction_per_m: 0.01, noise_sigma: 0.3, saturation: 900}");
  EXPECT_EQ(light.reference_reflectance, 0.1);
  EXPECT_EQ(light.reference_range_m, 55.0);
  EXPECT_EQ(light.range_exponent, 2.6);
  EXPECT_EQ(light.extinction_per_m, 0.01);
  EXPECT_EQ(light.noise_sigma, 0.3);
  EXPECT_EQ(light.saturation, 900.0);
  EXPECT_EQ(light.overlap, (LookupTable{{0.9, 0.0}, {1.0, 1.0}}));
}

TEST(PulseLightInASensorFile, TakesTheNoiseFromTheRangeOfNinetyPercent) {
  const LidarEquation light =
      pulse("{reference_reflectance: 0.8, reference_range_m: 120, range90_m: 100}");
  EXPECT_EQ(light.noise_sigma, noise_sigma_of(120.0, 100.0, 2.0));
}

TEST(SurfacesInASceneFile, SendBackAsTold) {
  EXPECT_TRUE(std::holds_alternative<Lambert>(
      testing::material_of_keys("backscatter: {type: lambert}").backscatter));
  const auto phong = std::get<PhongLike>(
      testing::material_of_keys("backscatter: {type: phong, specular_fraction: 0.4, exponent: 9}")
          .backscatter);
  EXPECT_EQ(phong.specular_fraction, 0.4);
  EXPECT_EQ(phong.exponent, 9.0);
  EXPECT_NEAR(std::get<OrenNayar>(
                  testing::material_of_keys("backscatter: {type: oren_nayar, roughness_deg: 20}")
                      .backscatter)
                  .roughness_rad,
              20.0 * kDegree, 1e-15);
  const auto retro = std::get<RetroReflector>(
      testing::material_of_keys("backscatter: {type: retro, gain: 500, width_deg: 25}")
          .backscatter);
  EXPECT_EQ(retro.gain, 500.0);
  EXPECT_NEAR(retro.width_rad, 25.0 * kDegree, 1e-15);
  const auto glossy = std::get<Glossy>(
      testing::material_of_keys(
          "backscatter: {type: glossy, diffuse_fraction: 0.1, lobe_gain: 4, width_deg: 2}")
          .backscatter);
  EXPECT_EQ(glossy.diffuse_fraction, 0.1);
  EXPECT_EQ(glossy.lobe_gain, 4.0);
  EXPECT_NEAR(glossy.width_rad, 2.0 * kDegree, 1e-15);
}

TEST(SurfacesInASceneFile, HaveASpectrumInNanometres) {
  const Material asphalt =
      testing::material_of_keys("spectrum: [[850, 0.269], [905, 0.278], [1550, 0.362]]");
  EXPECT_NEAR(reflectance_at(asphalt, 905e-9), 0.278, 1e-12);
  EXPECT_NEAR(reflectance_at(asphalt, 1550e-9), 0.362, 1e-12);
}

std::string sensor_error(const std::string& map) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", kOptics + "lidar_equation: " + map + "\n");
  return error_of(folder, [&] { load_sensor_file(file); });
}

TEST(PulseLightInASensorFile, RefusesWhatMeansNothingAndNamesThePlace) {
  EXPECT_EQ(sensor_error("{reference_range_m: 5}"),
            "s.yaml:2:17: lidar_equation: the key 'reference_reflectance' is missing; add "
            "'reference_reflectance: ...'");
  EXPECT_EQ(
      sensor_error("{reference_reflectance: 0.8, reference_range_m: 5, range90_m: 7}"),
      "s.yaml:2:79: lidar_equation.range90_m: 7, not below the reference range; allowed: metres "
      "below reference_range_m, which is seen with probability 1/2");
  EXPECT_EQ(
      sensor_error("{reference_reflectance: 0.8, reference_range_m: 5, overlap: [[2, 1], [1, "
                   "1]]}"),
      "s.yaml:2:87: lidar_equation.overlap[1][0]: 1, not above the one before; allowed: numbers "
      "that rise");
}

}  // namespace
}  // namespace glidar

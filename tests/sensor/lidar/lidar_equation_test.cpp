// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>
#include <support/parameter_name.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kSame = 1e-12;  // relative; a few roundings and those of the elementary functions

double cos_deg(double angle) {
  return std::cos(angle * std::numbers::pi / 180.0);
}

TEST(Backscatter, OfADiffuseSurfaceIsProportionalToTheCosine) {
  EXPECT_EQ(backscatter(Lambert{}, 0.4, 1.0), 0.4);
  EXPECT_NEAR(backscatter(Lambert{}, 0.4, cos_deg(60.0)), 0.2, kSame);
  EXPECT_EQ(backscatter(Lambert{}, 0.4, 0.0), 0.0);
}

TEST(Backscatter, MatchesThePublishedFormulasAtAnyAngle) {
  for (const double theta : {0.0, 0.2, 0.7, 1.2, 1.57}) {
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    EXPECT_NEAR(backscatter(PhongLike{0.3, 7.5}, 0.5, c),
                0.5 * (0.7 * c + 0.3 * std::pow(std::abs(std::cos(2.0 * theta)), 7.5)), kSame);
    const double rough = 0.4 * 0.4;
    EXPECT_NEAR(
        backscatter(OrenNayar{0.4}, 0.5, c),
        0.5 * ((1.0 - 0.5 * rough / (rough + 0.33)) * c + 0.45 * rough / (rough + 0.09) * s * s),
        kSame);
    EXPECT_NEAR(backscatter(RetroReflector{200.0, 0.5}, 0.9, c),
                0.9 * 200.0 * std::exp(-(theta / 0.5) * (theta / 0.5)), 200.0 * 1e-9);
    EXPECT_NEAR(backscatter(Glossy{0.05, 10.0, 0.05}, 0.9, c),
                0.9 * (0.05 * c + 10.0 * std::exp(-theta * theta / (2.0 * 0.05 * 0.05))), 1e-9);
  }
}

TEST(Backscatter, OfNarrowLobesIsTheDiffusePartAtGrazingIncidence) {
  for (int tenth = 0; tenth <= 900; ++tenth) {
    const double c = std::max(0.0, std::cos(0.1 * kDegree * tenth));
    for (const double width_deg : {0.1, 1.0, 2.0}) {
      const double width = width_deg * kDegree;
      const double glossy = backscatter(Glossy{0.5, 100.0, width}, 1.0, c);
      EXPECT_GE(glossy, 0.5 * c) << tenth;
      EXPECT_LE(glossy, 0.5 * c + 100.0) << tenth;
      const double retro = backscatter(RetroReflector{200.0, width}, 1.0, c);
      EXPECT_GE(retro, 0.0) << tenth;
      EXPECT_LE(retro, 200.0) << tenth;
      if (0.1 * tenth > 40.0 * width_deg) {
        EXPECT_EQ(glossy, 0.5 * c);
        EXPECT_EQ(retro, 0.0);
      }
    }
    const double phong = backscatter(PhongLike{0.5, 1000.0}, 1.0, c);
    EXPECT_GE(phong, 0.5 * c) << tenth;
    EXPECT_LE(phong, 0.5 * c + 0.5) << tenth;
  }
}

TEST(Backscatter, OfASmoothOrenNayarSurfaceIsLambertian) {
  EXPECT_NEAR(backscatter(OrenNayar{0.0}, 0.7, 0.6), backscatter(Lambert{}, 0.7, 0.6), kSame);
}

TEST(ReceivedSignal, IsOneForTheReferencePair) {
  const LidarEquation light{.reference_reflectance = 0.1,
                            .reference_range_m = 45.0,
                            .range_exponent = 2.6,
                            .overlap = {{0.0, 0.0}, {90.0, 1.0}},
                            .extinction_per_m = 0.01};
  EXPECT_NEAR(received_signal(light, 0.1, 45.0), 1.0, kSame);
}

TEST(ReceivedSignal, TimesTheSquareOfTheRangeIsConstant) {
  const LidarEquation light;
  const double expected = received_signal(light, 0.5, 10.0) * 100.0;
  for (const double range_m : {0.5, 3.0, 47.0, 1234.5}) {
    EXPECT_NEAR(received_signal(light, 0.5, range_m) * range_m * range_m, expected,
                kSame * expected);
  }
}

TEST(ReceivedSignal, ReachesTheThresholdAtARangeProportionalToTheRootOfReflectance) {
  const LidarEquation light{.reference_reflectance = 0.8, .reference_range_m = 120.0};
  for (const double rho : {0.05, 0.1, 0.8, 1.0}) {
    EXPECT_NEAR(received_signal(light, rho, 120.0 * std::sqrt(rho / 0.8)), 1.0, kSame);
  }
}

TEST(ReceivedSignal, IncludesTheTwoWayTransmissionOfTheAir) {
  // Kim's extinction at 905 nm: two-way transmission over 100 m 0.5434 at a visibility of 1 km.
  const double alpha = 3.050e-3;
  const LidarEquation clear;
  LidarEquation hazy;
  hazy.extinction_per_m = alpha;
  const double kept = received_signal(hazy, 0.5, 100.0 + 100.0) /
                      received_signal(hazy, 0.5, 100.0) /
                      (received_signal(clear, 0.5, 200.0) / received_signal(clear, 0.5, 100.0));
  EXPECT_NEAR(kept, 0.5434, 5e-5);
}

TEST(ReceivedSignal, WeatherAppliesFromTheSensorAndExtinctionFromTheReferenceRange) {
  const LidarEquation clear{.reference_range_m = 50.0, .extinction_per_m = 0.001};
  LidarEquation foggy = clear;
  foggy.weather_extinction_per_m = 0.01956;  // Kim's at 905 nm and a visibility of 0.2 km
  for (const double range_m : {1.0, 50.0, 100.0}) {
    EXPECT_NEAR(received_signal(foggy, 0.5, range_m) / received_signal(clear, 0.5, range_m),
                std::exp(-2.0 * 0.01956 * range_m), kSame);
  }
  EXPECT_NEAR(received_signal(foggy, 0.5, 100.0) / received_signal(clear, 0.5, 100.0), 0.0200,
              5e-5);
}

TEST(ReceivedSignal, FollowsTheOverlapTableAndIsConstantOutside) {
  const LidarEquation light{.reference_range_m = 10.0,
                            .overlap = {{0.9, 0.0}, {1.0, 1.0}}};  // Hahner et al., ICCV 2021
  EXPECT_EQ(received_signal(light, 0.8, 0.5), 0.0);
  EXPECT_NEAR(received_signal(light, 0.8, 0.95), 0.5 * (10.0 / 0.95) * (10.0 / 0.95), 1e-10);
  EXPECT_NEAR(received_signal(light, 0.8, 20.0), 0.25, kSame);
}

// Data sheets of Ouster, revision 6: ranges of 50 and 90 % probability.
struct SheetPair {
  const char* name;
  double reflectance;
  double range50_m;
  double range90_m;
  double noise_to_signal;  ///< threshold over noise, from the data sheet's pairs
};

void PrintTo(const SheetPair& pair, std::ostream* out) {
  *out << pair.name << ", reflectance " << pair.reflectance;
}

class DetectionOfSheets : public ::testing::TestWithParam<SheetPair> {};

TEST_P(DetectionOfSheets, ReproducesBothRangesOfTheDataSheet) {
  const SheetPair& sheet = GetParam();
  const LidarEquation light{.reference_reflectance = sheet.reflectance,
                            .reference_range_m = sheet.range50_m,
                            .noise_sigma = noise_sigma_of(sheet.range50_m, sheet.range90_m, 2.0)};
  EXPECT_NEAR(1.0 / light.noise_sigma, sheet.noise_to_signal, 0.05);
  const auto probability = [&](double range_m) {
    return detection_probability(light, received_signal(light, sheet.reflectance, range_m));
  };
  EXPECT_NEAR(probability(sheet.range50_m), 0.5, 1e-9);
  EXPECT_NEAR(probability(sheet.range90_m), 0.9, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Ouster, DetectionOfSheets,
                         ::testing::Values(SheetPair{"OS0", 0.1, 20.0, 15.0, 1.65},
                                           SheetPair{"OS0", 0.8, 50.0, 45.0, 5.5},
                                           SheetPair{"OS1", 0.1, 55.0, 45.0, 2.6},
                                           SheetPair{"OS1", 0.8, 120.0, 100.0, 2.9},
                                           SheetPair{"OS2", 0.1, 100.0, 80.0, 2.3},
                                           SheetPair{"OS2", 0.8, 240.0, 210.0, 4.2}),
                         testing::parameter_name<SheetPair>);

TEST(ReceivedSignal, HasTheExponentOfTwoReflectances) {
  EXPECT_NEAR(range_exponent(0.8, 120.0, 0.1, 40.0), 1.89, 0.005);   // OS1, first generation
  EXPECT_NEAR(range_exponent(0.8, 100.0, 0.1, 45.0), 2.60, 0.005);   // OS1, revision 6
  EXPECT_NEAR(range_exponent(0.8, 350.0, 0.1, 200.0), 3.72, 0.005);  // OS2, revision 7
}

/// Beams at normal incidence on a diffuse plane: reflectance 0.8, a signal per beam by its range.
struct Stage {
  Scene scene;
  Beams beams;
  Frame frame;

  explicit Stage(std::size_t size, double range_m) {
    Mesh mesh;
    mesh.triangles.resize(1);
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back();
    scene.instances.emplace_back().materials = {0};
    beams.rows = 1;
    beams.cols = static_cast<std::uint32_t>(size);
    beams.directions.assign(size, Eigen::Vector3d::UnitZ());
    resize(frame, size);
    frame.seed = 7;
    frame.status.assign(size, Status::hit);
    frame.range_m.assign(size, range_m);
    frame.ground_truth.range_m.assign(size, range_m);
    frame.ground_truth.instance.assign(size, 0);
    frame.ground_truth.primitive.assign(size, 0);
    frame.ground_truth.cos_shading.assign(size, 1.0F);
    frame.ground_truth.diffuse.assign(size, 0.8F);
  }
  void measure(const LidarEquation& light) {
    shade_lidar(light, scene, 905e-9, {}, {0, beams.size()}, frame);
  }
  [[nodiscard]] double share_of(Status status) const {
    return static_cast<double>(std::count(frame.status.begin(), frame.status.end(), status)) /
           static_cast<double>(beams.size());
  }
};

TEST(ShadeLidar, DetectsWithTheProbabilityOfTheDataSheet) {
  constexpr std::size_t kBeams = 100000;
  const LidarEquation light{.reference_reflectance = 0.8,
                            .reference_range_m = 120.0,
                            .noise_sigma = noise_sigma_of(120.0, 100.0, 2.0)};
  for (const auto& [range_m, probability] : {std::pair{120.0, 0.5}, std::pair{100.0, 0.9}}) {
    Stage stage(kBeams, range_m);
    stage.measure(light);
    const double deviation = std::sqrt(probability * (1.0 - probability) / kBeams);
    EXPECT_NEAR(stage.share_of(Status::hit), probability, 4.0 * deviation);
    EXPECT_NEAR(stage.share_of(Status::below_threshold), 1.0 - probability, 4.0 * deviation);
  }
}

TEST(ShadeLidar, EachChannelDetectsWithProbabilityOneHalfAtItsOwnRange) {
  constexpr std::size_t kBeams = 40000;
  const LidarEquation light{.reference_reflectance = 0.8,
                            .reference_range_m = 80.0,
                            .range_exponent = 2.4,
                            .noise_sigma = 0.3,
                            .channel_range_m = {80.0, 50.0, 120.0}};
  for (std::uint16_t ring = 0; ring < 3; ++ring) {
    const double range_m = light.channel_range_m[ring];
    Stage stage(kBeams, range_m);
    const std::vector<std::uint16_t> rings(kBeams, ring);
    shade_lidar(light, stage.scene, 905e-9, rings, {0, kBeams}, stage.frame);
    EXPECT_NEAR(stage.share_of(Status::hit), 0.5, 4.0 * 0.5 / std::sqrt(kBeams)) << ring;
    // the threshold is the signal there, in the unit that all channels share
    EXPECT_NEAR(channel_threshold(light, ring), std::pow(80.0 / range_m, 2.4), 1e-13);
  }
}

TEST(ShadeLidar, IntensitiesHaveTheSameUnitInAllChannels) {
  const LidarEquation light{
      .reference_reflectance = 0.8, .reference_range_m = 80.0, .channel_range_m = {80.0, 50.0}};
  Stage stage(2, 20.0);
  const std::vector<std::uint16_t> rings = {0, 1};
  shade_lidar(light, stage.scene, 905e-9, rings, {0, 2}, stage.frame);
  EXPECT_FLOAT_EQ(stage.frame.intensity[0], 16.0F);  // (80 / 20)^2
  EXPECT_FLOAT_EQ(stage.frame.intensity[1], 16.0F);
}

TEST(ShadeLidar, NoiseAloneIsNotAReturnOfASurface) {
  const LidarEquation light{
      .reference_reflectance = 0.8, .reference_range_m = 100.0, .noise_sigma = 0.4};
  Stage faint(100000, 1000.0);  // a signal of 0.01: noise passes the threshold once in 150 beams
  faint.measure(light);
  EXPECT_EQ(faint.share_of(Status::hit), 0.0);
  EXPECT_EQ(faint.share_of(Status::below_threshold), 1.0);
  EXPECT_EQ(detection_probability(light, 0.01), 0.0);
  Stage weak(100000, 400.0);  // a signal of 0.0625, above a tenth of the noise's deviation
  weak.measure(light);
  EXPECT_NEAR(weak.share_of(Status::hit), detection_probability(light, 0.0625), 0.001);
  EXPECT_GT(weak.share_of(Status::hit), 0.005);
}

TEST(ShadeLidar, IsIndependentOfHowBeamsAreDivided) {
  const LidarEquation light{.reference_range_m = 100.0, .noise_sigma = 0.3};
  Stage whole(1000, 95.0);
  Stage parts(1000, 95.0);
  whole.measure(light);
  for (const auto& [begin, end] :
       {std::pair{300U, 1000U}, std::pair{0U, 17U}, std::pair{17U, 300U}}) {
    shade_lidar(light, parts.scene, 905e-9, {}, {begin, end}, parts.frame);
  }
  EXPECT_EQ(whole.frame.status, parts.frame.status);
  EXPECT_EQ(whole.frame.intensity, parts.frame.intensity);
}

TEST(ShadeLidar, ReportsSaturationAndKeepsTheGroundTruth) {
  Stage stage(1, 1.0);
  stage.measure({.reference_range_m = 100.0, .saturation = 50.0});
  EXPECT_EQ(stage.frame.status[0], Status::saturated);
  EXPECT_TRUE(std::isnan(stage.frame.range_m[0]));
  EXPECT_EQ(stage.frame.ground_truth.range_m[0], 1.0);
}

TEST(ShadeLidar, ReportsWeatherForSurfacesDetectableInClearAir) {
  const LidarEquation light{
      .reference_reflectance = 0.8, .reference_range_m = 100.0, .weather_extinction_per_m = 0.002};
  for (const auto& [range_m, status] :
       {std::pair{50.0, Status::hit}, std::pair{99.0, Status::weather},
        std::pair{101.0, Status::below_threshold}}) {
    Stage stage(1, range_m);
    stage.measure(light);
    EXPECT_EQ(stage.frame.status[0], status) << range_m;
  }
}

TEST(ShadeLidar, UsesTheReflectanceAtTheSensorsWavelength) {
  Stage stage(1, 100.0);
  Material& material = stage.scene.materials[0];
  material.spectrum = {{850e-9, 0.2}, {950e-9, 0.4}};
  EXPECT_NEAR(reflectance_at(material, 905e-9), 0.31, kSame);
  EXPECT_EQ(reflectance_at(material, 500e-9), 0.2);
  EXPECT_EQ(reflectance_at(material, 1550e-9), 0.4);
  stage.measure({.reference_reflectance = 0.1, .reference_range_m = 100.0});
  EXPECT_NEAR(stage.frame.intensity[0], 3.1F, 1e-6F);
  stage.frame.ground_truth.diffuse[0] = 0.4F;  // a texture that halves it
  stage.measure({.reference_reflectance = 0.1, .reference_range_m = 100.0});
  EXPECT_NEAR(stage.frame.intensity[0], 1.55F, 1e-6F);
}

TEST(ReceivedSignals, AreThoseOfSingleHitsAndZeroForMisses) {
  Stage stage(40, 50.0);
  stage.scene.materials.emplace_back().spectrum = {{850e-9, 0.2}, {950e-9, 0.4}};
  stage.scene.instances.push_back(stage.scene.instances[0]);
  stage.scene.instances[1].materials = {1};
  stage.scene.meshes.push_back(stage.scene.meshes[0]);  // of two materials
  stage.scene.meshes[1].material_slots = {0, 1};
  stage.scene.instances.emplace_back().mesh = 1;
  stage.scene.instances[2].materials = {0, 1};
  Hits& hits = stage.frame.ground_truth;
  for (std::uint32_t i = 0; i < 40; ++i) {
    hits.instance[i] = i % 3;
    hits.primitive[i] = i % 3 == 2 ? i % 2 : 0;
    hits.range_m[i] = 3.0 + i;
  }
  hits.instance[20] = kInvalidId;
  hits.range_m[20] = std::nan("");
  for (const double extinction_per_m : {0.0, 0.01}) {  // vectorised, and one by one
    const LidarEquation light{.extinction_per_m = extinction_per_m};
    std::vector<double> signals(30);
    received_signals(light, stage.scene, 905e-9, hits, {10, 40}, signals);
    for (std::size_t i = 10; i < 40; ++i) {
      const double alone =
          i == 20 ? 0.0
                  : received_signal(light, backscatter_at(stage.scene, 905e-9, hits, i),
                                    hits.range_m[i]);
      EXPECT_EQ(signals[i - 10], alone) << i;
    }
  }
}

TEST(LidarEquation, RejectsInvalidNumbers) {
  EXPECT_NO_THROW(validate(LidarEquation{}));
  EXPECT_THROW(validate(LidarEquation{.reference_reflectance = 0.0}), Error);
  EXPECT_THROW(validate(LidarEquation{.reference_range_m = -1.0}), Error);
  EXPECT_THROW(validate(LidarEquation{.range_exponent = std::nan("")}), Error);
  EXPECT_THROW(validate(LidarEquation{.overlap = {{2.0, 1.0}, {1.0, 1.0}}}), Error);
  EXPECT_THROW(
      validate(LidarEquation{.reference_range_m = 1.0, .overlap = {{5.0, 0.0}, {6.0, 1.0}}}),
      Error);
  EXPECT_THROW(validate(LidarEquation{.noise_sigma = -0.1}), Error);
  EXPECT_THROW(validate(LidarEquation{.weather_extinction_per_m = -0.1}), Error);
}

}  // namespace
}  // namespace glidar

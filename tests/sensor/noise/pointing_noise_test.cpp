// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include "sensor/noise_stage.hpp"

#include <numbers>

namespace glidar {
namespace {

using testing::expect_normal;
using testing::moments;
using testing::NoiseStage;

Eigen::Vector3d direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Makes a turning sensor of it, whose beams all look one way.
void look(double azimuth, double elevation, NoiseStage& stage) {
  stage.beams.boresight = Eigen::Vector3d::UnitX();
  for (Eigen::Vector3d& beam : stage.beams.directions) beam = direction(azimuth, elevation);
}

const Beams& aimed(NoiseStage& stage, const NoiseStep& step) {
  return stage.perturb({step});
}

TEST(PointingJitter, HasTheStatedAnglesOnTheSphere) {
  NoiseStage stage(100, 1000, 10.0);
  look(0.7, 0.5, stage);
  const Beams& beams =
      aimed(stage, PointingJitter{.sigma_azimuth_rad = 1e-3, .sigma_elevation_rad = 2e-3});
  validate(beams);
  std::vector<double> aside;
  std::vector<double> upwards;
  for (const Eigen::Vector3d& beam : beams.directions) {
    aside.push_back((std::atan2(beam.y(), beam.x()) - 0.7) * std::cos(0.5));
    upwards.push_back(std::asin(beam.z()) - 0.5);
  }
  expect_normal(moments(aside), 0.0, 1e-3);
  expect_normal(moments(upwards), 0.0, 2e-3);
}

TEST(PointingJitter, OfACameraIsAcrossAndAlongItsImage) {
  NoiseStage stage(100, 1000, 10.0);
  const Beams& beams =
      aimed(stage, PointingJitter{.sigma_azimuth_rad = 1e-3, .sigma_elevation_rad = 2e-3});
  std::vector<double> x;
  std::vector<double> y;
  for (const Eigen::Vector3d& beam : beams.directions) {
    x.push_back(beam.x());
    y.push_back(beam.y());
  }
  expect_normal(moments(x), 0.0, 1e-3);
  expect_normal(moments(y), 0.0, 2e-3);
}

TEST(PointingJitter, KeepsPixelsWithoutABeamAndPerturbsVerticalBeams) {
  NoiseStage stage(1, 10, 10.0);
  look(0.0, 0.5 * std::numbers::pi, stage);
  stage.beams.directions[0] = Eigen::Vector3d::UnitZ();
  stage.beams.directions[1].setConstant(std::nan(""));
  const Beams& beams = aimed(stage, PointingJitter{.sigma_azimuth_rad = 1e-3});
  EXPECT_TRUE(std::isnan(beams.directions[1].x()));
  EXPECT_NE(beams.directions[0].x(), 0.0);
  EXPECT_NEAR(beams.directions[0].norm(), 1.0, 1e-15);
}

TEST(PointingJitter, DoesNotChangeTheNominalBeams) {
  NoiseStage stage(1, 10, 1.0);
  const Beams& beams = aimed(stage, PointingJitter{.sigma_azimuth_rad = 1e-3});
  EXPECT_NE(&beams, &stage.beams);
  EXPECT_EQ(stage.beams.directions[3], Eigen::Vector3d::UnitZ());
  EXPECT_EQ(&aimed(stage, RangeGaussian{}), &stage.beams);
}

TEST(EncoderError, ReportedMinusTrueAzimuthMatchesTheModel) {
  const EncoderError law{
      .step_rad = 0.01 * kDegree, .eccentricity_rad = 0.05 * kDegree, .phase_rad = 0.3};
  NoiseStage stage(1, 1000, 10.0);
  stage.beams.boresight = Eigen::Vector3d::UnitX();
  const auto azimuth_of = [](std::size_t i) { return 0.001 + 0.0062 * static_cast<double>(i); };
  for (std::size_t i = 0; i < 1000; ++i) stage.beams.directions[i] = direction(azimuth_of(i), 0.2);
  stage.beams.origins_m.assign(1000, Eigen::Vector3d(0.1, 0.0, 0.02));
  const Beams& beams = aimed(stage, law);
  validate(beams);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double reported = azimuth_of(i);
    const Eigen::Vector3d& v = beams.directions[i];
    const double apart = std::remainder(reported - std::atan2(v.y(), v.x()), 2 * std::numbers::pi);
    const double rounding = std::round(reported / law.step_rad) * law.step_rad - reported;
    EXPECT_NEAR(apart, rounding + law.eccentricity_rad * std::sin(reported + 0.3), 1e-12);
    EXPECT_LE(std::abs(rounding), 0.5 * law.step_rad + 1e-12);
    EXPECT_NEAR(std::asin(v.z()), 0.2, 1e-12);
    const Eigen::Vector3d& origin = beams.origins_m[i];
    EXPECT_NEAR(std::atan2(origin.y(), origin.x()), -apart, 1e-12);
  }
}

TEST(EncoderError, OfATurnIsTheSameForAllItsBeamsAndNormalOverTurns) {
  NoiseStage stage(1, 2, 10.0);
  stage.beams.boresight = Eigen::Vector3d::UnitX();
  for (Eigen::Vector3d& beam : stage.beams.directions) beam = Eigen::Vector3d::UnitX();
  std::vector<double> errors;
  for (std::uint32_t frame = 0; frame < 10000; ++frame) {
    stage.frame.number = frame;
    const Beams& beams = aimed(stage, EncoderError{.turn_sigma_rad = 1e-3});
    EXPECT_EQ(beams.directions[0], beams.directions[1]);
    errors.push_back(std::asin(beams.directions[0].y()));
  }
  expect_normal(moments(errors), 0.0, 1e-3);
}

}  // namespace
}  // namespace glidar

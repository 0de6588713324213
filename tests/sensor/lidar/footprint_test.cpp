// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/sensor/lidar/footprint.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace glidar {
namespace {

constexpr Footprint kOval{.divergence_x_rad = 3e-3,
                          .divergence_y_rad = 1.5e-3,
                          .exit_x_m = 0.0095,
                          .exit_y_m = 0.0127,
                          .rings = 2};

double share_of_first(const std::vector<SubRay>& rays, std::size_t count) {
  return std::accumulate(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(count), 0.0,
                         [](double sum, const SubRay& ray) { return sum + ray.share; });
}

// 0.3935 of a Gaussian's energy is within half its 1/e^2 radius, 0.8647
// within it; two rings are cut there.
TEST(SubRays, HaveTheEnergyOfAGaussianInTheirRings) {
  const std::vector<SubRay> rays = sample_footprint(kOval);
  ASSERT_EQ(rays.size(), 1U + 6U + 12U);
  EXPECT_NEAR(share_of_first(rays, 1), 0.3935, 5e-5);
  EXPECT_NEAR(share_of_first(rays, 7), 0.8647, 5e-5);
  EXPECT_NEAR(share_of_first(rays, 19), 1.0, 1e-15);
}

TEST(SubRays, AreSevenWithOneRing) {
  Footprint one = kOval;
  one.rings = 1;
  EXPECT_EQ(sample_footprint(one).size(), 7U);
}

TEST(SubRays, HaveTheSecondMomentOfTheBeamAtEveryRange) {
  for (unsigned rings = 1; rings <= kMaxRings; ++rings) {
    Footprint footprint = kOval;
    footprint.rings = rings;
    for (const double range_m : {0.0, 5.0, 100.0}) {
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      Eigen::Vector2d square = Eigen::Vector2d::Zero();
      for (const SubRay& ray : sample_footprint(footprint)) {
        const Eigen::Vector2d at = ray.offset_m + range_m * ray.slope;
        mean += ray.share * at;
        square += ray.share * at.cwiseAbs2();
      }
      // a Gaussian's standard deviation is a quarter of its full 1/e^2 width
      const double wide = std::hypot(kOval.exit_x_m, kOval.divergence_x_rad * range_m) / 4.0;
      const double high = std::hypot(kOval.exit_y_m, kOval.divergence_y_rad * range_m) / 4.0;
      EXPECT_LT(mean.norm(), 1e-15 * (1.0 + range_m));
      EXPECT_NEAR(std::sqrt(square.x()), wide, 1e-12 * (1.0 + range_m));
      EXPECT_NEAR(std::sqrt(square.y()), high, 1e-12 * (1.0 + range_m));
    }
  }
}

/// Rms error of the lit part of a beam that a straight edge cuts, over all directions of the edge
/// and its positions up to 1.2 w from the centre; of a Gaussian it is (1 + erf(sqrt(2) place)) / 2.
double cut_error(unsigned rings) {
  const Footprint round{.exit_x_m = 2.0, .exit_y_m = 2.0, .rings = rings};  // w = 1
  const std::vector<SubRay> rays = sample_footprint(round);
  constexpr int kDirections = 60;
  constexpr int kPlaces = 121;
  double squares = 0.0;
  for (int d = 0; d < kDirections; ++d) {
    const double angle = std::numbers::pi * d / kDirections;
    const Eigen::Vector2d across(std::cos(angle), std::sin(angle));
    for (int k = 0; k < kPlaces; ++k) {
      const double place = 1.2 * (2.0 * k / (kPlaces - 1.0) - 1.0);
      double lit = 0.0;
      for (const SubRay& ray : rays) lit += ray.offset_m.dot(across) < place ? ray.share : 0.0;
      squares += std::pow(lit - 0.5 * (1.0 + std::erf(std::numbers::sqrt2 * place)), 2);
    }
  }
  return std::sqrt(squares / (kDirections * kPlaces));
}

// The reason for one ring in the sensor presets.
TEST(SubRays, OneRingEstimatesACutBeamNearlyAsWellAsTwo) {
  EXPECT_NEAR(cut_error(1), 0.076, 0.001);
  EXPECT_NEAR(cut_error(2), 0.069, 0.001);
  EXPECT_NEAR(cut_error(3), 0.034, 0.001);
}

// A Gaussian beam's exit and divergence add in quadrature, although data sheets often add them
// linearly.
TEST(DiameterM, IsThatOfAGaussianBeam) {
  EXPECT_DOUBLE_EQ(diameter_m(kOval, 0.0), 0.0127);
  EXPECT_NEAR(diameter_m(kOval, 100.0), std::hypot(0.0095, 0.3), 1e-15);
}

TEST(ExpandBeams, SubRaysCrossTheBeamWithItsTimeAndOrigin) {
  Beams beams;
  beams.rows = 1;
  beams.cols = 2;
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions = {Eigen::Vector3d::UnitX(), Eigen::Vector3d(0.6, 0.8, 0.0)};
  beams.origins_m = {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.1, 0.2, 0.3)};
  beams.times_ns = {5, 7};
  const std::vector<SubRay> rays = sample_footprint(kOval);
  Beams out;
  ThreadPool thread_pool(1);
  expand_beams(rays, beams, {1, 2}, thread_pool, out);
  ASSERT_EQ(out.size(), rays.size());
  EXPECT_NO_THROW(validate(out));
  EXPECT_EQ(out.directions[0], beams.directions[1]);
  EXPECT_EQ(out.origins_m[0], beams.origins_m[1]);
  EXPECT_EQ(out.times_ns[3], 7U);
  const Eigen::Vector3d side(0.8, -0.6, 0.0);  // to the right, seen along the beam with z up
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Eigen::Vector3d offset = out.origins_m[k] - beams.origins_m[1];
    EXPECT_NEAR(offset.dot(side), rays[k].offset_m.x(), 1e-15);
    EXPECT_NEAR(offset.z(), rays[k].offset_m.y(), 1e-15);
    const Eigen::Vector3d direction =
        out.directions[k] / out.directions[k].dot(beams.directions[1]);
    EXPECT_NEAR(direction.dot(side), rays[k].slope.x(), 1e-15);
    EXPECT_NEAR(direction.z(), rays[k].slope.y(), 1e-15);
  }
}

TEST(ExpandBeams, IsIndependentOfTheOtherBeams) {
  Beams beams;
  beams.rows = 1;
  beams.cols = 300;
  beams.boresight = Eigen::Vector3d::UnitX();
  for (int i = 0; i < 300; ++i) {
    const double angle = 0.01 * i;
    beams.directions.emplace_back(std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle));
  }
  beams.directions[37] =
      Eigen::Vector3d::UnitZ();  // straight up, where the sideways direction is undefined
  const std::vector<SubRay> rays = sample_footprint(kOval);
  ThreadPool thread_pool(2);
  Beams all;
  expand_beams(rays, beams, {0, 300}, thread_pool, all);
  EXPECT_NO_THROW(validate(all));
  for (std::size_t beam = 0; beam < 300; ++beam) {
    Beams one;
    expand_beams(rays, beams, {beam, beam + 1}, thread_pool, one);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      EXPECT_EQ(one.directions[k], all.directions[beam * rays.size() + k]) << beam;
      EXPECT_EQ(one.origins_m[k], all.origins_m[beam * rays.size() + k]) << beam;
    }
  }
}

TEST(ExpandBeams, KeepsABeamWithoutWidth) {
  Beams beams;
  beams.rows = beams.cols = 1;
  beams.directions = {Eigen::Vector3d(0.1, -0.2, 0.97).normalized()};
  Beams out;
  ThreadPool thread_pool(1);
  expand_beams({SubRay{}}, beams, {0, 1}, thread_pool, out);
  EXPECT_EQ(out.directions, beams.directions);
  EXPECT_TRUE(out.origins_m.empty());
}

TEST(ValidateFootprint, ReportsTheNumberOutOfRange) {
  Footprint bad = kOval;
  bad.rings = 0;
  EXPECT_THROW(validate(bad), Error);
  bad = kOval;
  bad.divergence_x_rad = -1e-3;
  EXPECT_NE(error_text([&] { validate(bad); }).find("divergence_x_rad"), std::string::npos);
}

}  // namespace
}  // namespace glidar

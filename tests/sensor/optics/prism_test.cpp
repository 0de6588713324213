// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/windows.hpp"

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/prism.hpp>

namespace glidar {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr auto kEntry = RisleyPrism::Slope::entry;
constexpr auto kExit = RisleyPrism::Slope::exit;

// Fitted to Livox' scan tables.
Prism mid40() {
  return {.prisms = {{121.56667, 18.7723 * kDegree, 90.0 * kDegree, 1.51, kEntry},
                     {-77.73333, 17.9630 * kDegree, 90.0 * kDegree, 1.51, kEntry}},
          .incidence_tangent = {0.0},
          .pulse_hz = 100e3};
}

Prism mid70() {
  return {.prisms = {{121.56667, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kEntry},
                     {-77.73333, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kExit}},
          .incidence_tangent = {0.0},
          .pulse_hz = 100e3};
}

// Numbers of HELIOS++ (scanner catalogue), which fitted them to the sensor.
Prism avia() {
  return {.prisms = {{-131.5463, 30.8856 * kDegree, 0.0, 1.51, kEntry},
                     {40.8032, 29.7735 * kDegree, 0.0, 1.51, kEntry},
                     {213.1611, 3.1351 * kDegree, 0.0, 1.51, kEntry}},
          .incidence_tangent = {-0.05216070, -0.03237635, -0.01079672, 0.01079672, 0.03237635,
                                0.05300785},
          .pulse_hz = 40e3};
}

double widest_deg(const Beams& beams) {
  double widest = 0.0;
  for (const Eigen::Vector3d& d : beams.directions) {
    widest = std::max(widest, std::atan2(d.tail<2>().norm(), d.x()) / kDegree);
  }
  return widest;
}

// The first rows of Livox' scan tables (10 us), azimuth to the left and elevation.
TEST(Prism, BeginsAsLivoxScanTables) {
  constexpr double kTolerance_deg = 5e-4;  // the tables are printed to 1e-4; the fit has 5e-4
  const auto expect_second_shot = [&](const Prism& prism, double azimuth_deg,
                                      double elevation_deg) {
    const Eigen::Vector3d d = make_beams(prism, {0, kSecond_ns / 10}).directions[1];
    EXPECT_NEAR(std::atan2(d.y(), d.x()) / kDegree, azimuth_deg, kTolerance_deg);
    EXPECT_NEAR(std::asin(d.z()) / kDegree, elevation_deg, kTolerance_deg);
  };
  expect_second_shot(mid40(), 19.1724, 0.0301);
  expect_second_shot(mid70(), -35.2147, -0.0242);
}

// Directions of two prisms computed by another program (HELIOS++, with its numbers of the Mid-40).
TEST(Prism, TwoPrismsDeflectAsInHelios) {
  const Prism prism = {.prisms = {{-121.5657, 18.7481 * kDegree, 0.0, 1.51, kEntry},
                                  {77.7430, 17.9634 * kDegree, 0.0, 1.51, kEntry}},
                       .incidence_tangent = {0.0},
                       .pulse_hz = 100e3};
  const Beams beams = make_beams(prism, {0, kSecond_ns / 10});
  validate(beams);
  ASSERT_EQ(beams.size(), 10'000U);
  // Published axes: x right, y forward, z up; computed independently at t = 0, 1, 2.5, 10 ms.
  const std::vector<std::pair<std::size_t, Eigen::Vector3d>> golden = {
      {0, {0.0, 0.944606, -0.328206}},
      {100, {0.041355, 0.963109, -0.265916}},
      {250, {0.000426, 0.999998, -0.001808}},
      {1000, {0.321926, 0.944631, -0.063525}}};
  for (const auto& [shot, d] : golden) {
    const Eigen::Vector3d expected(d.y(), -d.x(), d.z());
    EXPECT_LT((beams.directions[shot] - expected).cwiseAbs().maxCoeff(), 1e-6) << shot;
    EXPECT_EQ(beams.times_ns[shot], shot * 10'000);
  }
}

TEST(Prism, FieldsOfViewAreThoseOfTheDataSheets) {
  const FrameInterval second = {0, kSecond_ns};
  // The greatest angles of Livox' scan tables; data sheets: 38.4 / 2 and 70.4 / 2.
  EXPECT_NEAR(widest_deg(make_beams(mid40(), second)), 19.173, 1e-3);
  EXPECT_NEAR(widest_deg(make_beams(mid70(), second)), 35.216, 1e-3);
  const Beams beams = make_beams(avia(), second);
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& d : beams.directions) {
    const Eigen::Vector2d angles(std::atan2(d.y(), d.x()), std::asin(d.z()));
    low = low.cwiseMin(angles);
    high = high.cwiseMax(angles);
  }
  const Eigen::Vector2d size_deg = (high - low) / kDegree;
  EXPECT_NEAR(size_deg.x(), 77.2, 0.2);  // of the data sheet; the model is a fit
  EXPECT_NEAR(size_deg.y(), 70.4, 0.2);
}

TEST(Prism, ThinPrismsDeflectByIndexLessOneTimesApex) {
  const double apex_rad = 0.01;
  for (const auto slope : {kEntry, kExit}) {
    const Prism thin = {.prisms = {{1.0, apex_rad, 0.0, 1.5, slope}}};
    const Beams beams = make_beams(thin, {0, kSecond_ns / 1000});
    // the next term of the series is of third order in the apex angle
    EXPECT_NEAR(widest_deg(beams) * kDegree, 0.5 * apex_rad, apex_rad * apex_rad * apex_rad);
  }
}

TEST(Prism, SeveralBeamsAreRowsAndRings) {
  const Beams beams = make_beams(avia(), {0, kSecond_ns / 10});
  EXPECT_EQ(beams.rows, 6U);
  EXPECT_EQ(beams.cols, 4000U);  // 240 000 points per second
  EXPECT_EQ(beams.rings[5 * std::size_t{beams.cols}], 5U);
}

TEST(Prism, ContinuesAcrossIntervals) {
  testing::expect_windows_join(mid40(), 0, kSecond_ns / 5);
  testing::expect_windows_join(avia(), 977 * kSecond_ns + 3, 977 * kSecond_ns + kSecond_ns / 9);
  const Beams first = make_beams(mid40(), {0, kSecond_ns / 10});
  const Beams second = make_beams(mid40(), {kSecond_ns / 10, kSecond_ns / 5});
  EXPECT_GT((first.directions[0] - second.directions[0]).norm(), 0.01);  // it does not repeat
}

TEST(Prism, TotalReflectionIsNoBeam) {
  const Prism steep = {.prisms = {{1.0, 60.0 * kDegree, 0.0, 1.9, kExit}}};
  for (const Eigen::Vector3d& d : make_beams(steep, {0, kSecond_ns / 1000}).directions) {
    EXPECT_TRUE(std::isnan(d.x()));
  }
}

TEST(Prism, RejectsNumbersOutOfRange) {
  const FrameInterval window = {0, kSecond_ns / 10};
  EXPECT_THROW(make_beams(Prism{}, window), Error);  // no prism
  Prism prism = mid40();
  prism.incidence_tangent = {1.0};
  EXPECT_THROW(make_beams(prism, window), Error);
  prism = mid40();
  prism.prisms[0].refractive_index = 0.5;
  EXPECT_THROW(make_beams(prism, window), Error);
}

}  // namespace
}  // namespace glidar

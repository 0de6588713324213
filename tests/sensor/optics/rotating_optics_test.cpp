// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/rotating_optics.hpp>

#include "sensor/windows.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <support/error_text.hpp>
#include <support/source_folder.hpp>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace glidar {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr auto kEntry = RisleyPrism::Slope::entry;
constexpr auto kExit = RisleyPrism::Slope::exit;

// Fitted to Livox' scan tables.
Prism mid40() {
  return {.prisms = {{121.56667, 18.0 * kDegree, 90.0 * kDegree, 1.53294, kEntry},
                     {-77.73333, 18.0 * kDegree, 90.0 * kDegree, 1.5089, kEntry}},
          .incidence_rad = {0.0},
          .pulse_hz = 100e3};
}

Prism mid70() {
  return {.prisms = {{121.56667, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kEntry},
                     {-77.73333, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kExit}},
          .incidence_rad = {0.0},
          .pulse_hz = 100e3};
}

Prism avia() {
  Prism prism = {.prisms = {{131.55, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kEntry},
                            {-40.8, 18.0 * kDegree, 270.0 * kDegree, 1.8144, kExit}},
                 .incidence_rad = {},
                 .incidence_roll_rad = 90.0 * kDegree,
                 .pulse_hz = 40e3};
  for (const double angle_deg : {2.242931, 1.346204, 0.448806, -0.448806, -1.346204, -2.242931})
    prism.incidence_rad.push_back(angle_deg * kDegree);
  return prism;
}

double widest_deg(const Beams& beams) {
  double widest = 0.0;
  for (const Eigen::Vector3d& d : beams.directions) {
    widest = std::max(widest, std::atan2(d.tail<2>().norm(), d.x()) / kDegree);
  }
  return widest;
}

// Directions of two prisms computed by another program (HELIOS++, with its numbers of the Mid-40).
TEST(Prism, TwoPrismsDeflectAsInHelios) {
  const Prism prism = {.prisms = {{-121.5657, 18.7481 * kDegree, 0.0, 1.51, kEntry},
                                  {77.7430, 17.9634 * kDegree, 0.0, 1.51, kEntry}},
                       .incidence_rad = {0.0},
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
  // Of the scan table, of which this is a quarter; data sheet: 70.4 x 77.2.
  EXPECT_NEAR(size_deg.x(), 70.618, 5e-3);
  EXPECT_NEAR(size_deg.y(), 77.183, 5e-3);
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

TEST(Prism, IncidentBeamsPointToTheRightOrUp) {
  Prism glass = {.prisms = {{1.0, 0.0, 0.0, 1.5, kEntry}}};  // it deflects nothing
  const double angle_rad = 20.0 * kDegree;
  glass.incidence_rad = {angle_rad};
  const auto direction = [&] { return make_beams(glass, {0, kSecond_ns / 1000}).directions[0]; };
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  EXPECT_LT((direction() - Eigen::Vector3d(c, -s, 0.0)).norm(), 1e-15);
  glass.incidence_roll_rad = 90.0 * kDegree;
  EXPECT_LT((direction() - Eigen::Vector3d(c, 0.0, s)).norm(), 1e-15);
  glass.incidence_roll_rad = 30.0 * kDegree;
  EXPECT_LT((direction() - Eigen::Vector3d(c, -s * std::sqrt(0.75), 0.5 * s)).norm(), 1e-15);
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
  prism.incidence_rad = {0.5 * std::numbers::pi};
  EXPECT_THROW(make_beams(prism, window), Error);
  prism = mid40();
  prism.incidence_roll_rad = std::numeric_limits<double>::infinity();
  EXPECT_THROW(make_beams(prism, window), Error);
  prism = mid40();
  prism.prisms[0].refractive_index = 0.5;
  EXPECT_THROW(make_beams(prism, window), Error);
}

constexpr std::int64_t kSecond = 1'000'000'000;  // in ns

WedgeMirror mid360() {
  WedgeMirror optics;
  optics.incidence_rad.clear();
  optics.wedge = {-172.416667, 269.39 * kDegree, 31.167 * kDegree, 1.593, 0.15, 20.0};
  optics.mirror = {-182.416667, 90.0 * kDegree, 50.0 * kDegree, 1.9682, 0.0, 0.0};
  for (const double k : {-1.5, -0.5, 0.5, 1.5})
    optics.incidence_rad.push_back(k * 1.4173 * kDegree);
  optics.pulse_hz = 50e3;
  optics.first_pulse_ns = 10e3;
  return optics;
}

/// A direction of the manufacturer's scan table.
struct TableRow {
  std::size_t firing = 0;
  std::size_t beam = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

std::vector<TableRow> table_rows() {
  std::ifstream file(std::string(kSourceFolder) + "/tests/sensor/optics/mid360_rows.csv");
  std::vector<TableRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream text(line);
    std::size_t row = 0;
    double azimuth_deg = 0.0;
    double elevation_deg = 0.0;
    char comma = 0;
    text >> row >> comma >> azimuth_deg >> comma >> elevation_deg;
    rows.push_back({(row - 1) / 4, (row - 1) % 4,
                    direction_at(azimuth_deg * kDegree, elevation_deg * kDegree)});
  }
  return rows;
}

/// In degrees; exact for small angles.
double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

TEST(WedgeMirror, Mid360HasTheDirectionsOfLivoxScanTable) {
  const std::vector<TableRow> rows = table_rows();
  ASSERT_EQ(rows.size(), 560U);
  const Beams beams = make_beams(mid360(), {0, kSecond});
  ASSERT_EQ(beams.rows, 4U);
  ASSERT_EQ(beams.cols, 50'000U);
  constexpr double kTolerance_deg = 0.011;  // the table is printed to 0.01
  double sum_of_squares = 0.0;
  for (const TableRow& row : rows) {
    const double error_deg =
        angle_deg(beams.directions[row.beam * beams.cols + row.firing], row.direction);
    EXPECT_LT(error_deg, kTolerance_deg) << "firing " << row.firing << ", beam " << row.beam;
    sum_of_squares += error_deg * error_deg;
  }
  EXPECT_LT(std::sqrt(sum_of_squares / 560.0), 0.0045);
}

TEST(WedgeMirror, FourBeamsFireAtOnceEvery20Microseconds) {
  const Beams beams = make_beams(mid360(), {0, kSecond / 10});
  validate(beams);
  ASSERT_EQ(beams.cols, 5'000U);
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_EQ(beams.times_ns[row * beams.cols], 10'000U);
    EXPECT_EQ(beams.times_ns[row * beams.cols + 7], 150'000U);
    EXPECT_EQ(beams.rings[row * beams.cols + 7], row);
  }
}

TEST(WedgeMirror, ContinuesAcrossIntervals) {
  testing::expect_windows_join(mid360(), 0, kSecond / 5);
  testing::expect_windows_join(mid360(), 977 * kSecond + 3, 977 * kSecond + kSecond / 9);
}

TEST(WedgeMirror, ElevationsSpanThoseOfTheDataSheet) {
  const Beams beams = make_beams(mid360(), {0, kSecond});
  double low = 90.0;
  double high = -90.0;
  for (const Eigen::Vector3d& d : beams.directions) {
    low = std::min(low, std::asin(d.z()) / kDegree);
    high = std::max(high, std::asin(d.z()) / kDegree);
  }
  EXPECT_NEAR(low, -7.0, 0.3);  // data sheet: -7 to 52
  EXPECT_NEAR(high, 52.0, 0.3);
}

// Without glass only the mirror acts: a vertical beam leaves at 2 tilt - 90 degrees, opposite to
// the mirror's azimuth.
TEST(WedgeMirror, WithoutGlassOnlyTheMirrorActs) {
  WedgeMirror optics;
  optics.wedge = {3.0, 0.3, 20.0 * kDegree, 1.0, 0.0, 0.0};
  optics.mirror = {25.0, 10.0 * kDegree, 50.0 * kDegree, 1.0, 0.0, 0.0};
  optics.pulse_hz = 1'000.0;
  const Beams beams = make_beams(optics, {0, kSecond / 10});
  for (std::size_t k = 0; k < beams.cols; ++k) {
    const double azimuth_rad = 190.0 * kDegree + kTwoPi * 25.0 * 1e-3 * static_cast<double>(k);
    EXPECT_LT((beams.directions[k] - direction_at(azimuth_rad, 10.0 * kDegree)).norm(), 1e-13) << k;
  }
}

TEST(WedgeMirror, TotallyReflectedBeamsAreNoBeams) {
  WedgeMirror optics = mid360();
  optics.wedge.tilt_rad = 60.0 * kDegree;  // beyond the critical angle of 39 degrees
  const Beams beams = make_beams(optics, {0, kSecond / 1000});
  for (const Eigen::Vector3d& d : beams.directions) EXPECT_TRUE(d.hasNaN());
}

TEST(WedgeMirror, RefusesNumbersOutOfRange) {
  const auto error_with = [](auto change) {
    WedgeMirror optics = mid360();
    change(optics);
    return error_text([&] { make_beams(optics, {0, 1000}); });
  };
  EXPECT_EQ(error_with([](WedgeMirror& o) { o.wedge.tilt_rad = 1.6; }),
            "optics, wedge, tilt: 1.6; allowed: from 0 to below pi/2");
  EXPECT_EQ(error_with([](WedgeMirror& o) { o.mirror.refractive_index = 0.5; }),
            "optics, mirror, refractive index: 0.5; allowed: 1 to 10");
  EXPECT_EQ(error_with([](WedgeMirror& o) { o.mirror.rotation_hz = kNaN; }),
            "optics, mirror, rotation: nan; allowed: a finite number");
  EXPECT_EQ(error_with([](WedgeMirror& o) { o.pulse_hz = 0.0; }),
            "optics, pulses per second: 0; allowed: above 0, up to 1e9");
  EXPECT_EQ(error_with([](WedgeMirror& o) { o.incidence_rad.clear(); }),
            "optics, number of incident beams: 0; allowed: 1 to 64");
}

}  // namespace

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/rotating_optics.hpp>

#include "sensor/windows.hpp"

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <support/error_text.hpp>
#include <support/source_folder.hpp>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace glidar {
namespace {

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

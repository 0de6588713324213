// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/math/constants.hpp>

#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace glidar {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

/// Two rows of a whole turn, clockwise from ahead, the lower one ahead of the other by an angle.
Beams staggered(double offset_deg, std::uint32_t cols = 360, double step_deg = -1.0) {
  Beams beams;
  beams.rows = 2;
  beams.cols = cols;
  beams.boresight = Eigen::Vector3d::UnitX();
  for (int row = 0; row < 2; ++row) {
    for (std::uint32_t col = 0; col < cols; ++col) {
      const double azimuth = (step_deg * col + (row == 1 ? offset_deg : 0.0)) * kRadian;
      beams.directions.push_back(direction_at(azimuth, (row == 0 ? 5.0 : -5.0) * kRadian));
    }
  }
  return beams;
}

double azimuth_deg(const Beams& beams, std::uint32_t beam) {
  return azimuth_rad(axes_of(beams), beams.directions[beam]) / kRadian;
}

/// The largest difference of azimuth within a column, in degrees.
double widest_column_deg(const BeamPicture& picture, const Beams& beams) {
  double widest = 0.0;
  for (std::uint32_t col = 0; col < picture.cols; ++col) {
    double first = kNaN;
    for (std::uint32_t row = 0; row < picture.rows; ++row) {
      const std::uint32_t beam = picture.beam_at(row * picture.cols + col);
      if (beam == BeamPicture::kNoBeam) continue;
      const double azimuth = azimuth_deg(beams, beam);
      if (std::isnan(first)) first = azimuth;
      const double apart = std::remainder(azimuth - first, 360.0);
      widest = std::max(widest, std::abs(apart));
    }
  }
  return widest;
}

std::vector<double> no_returns(const Beams& beams) {
  return std::vector<double>(beams.size(), kNaN);
}

TEST(BeamPicture, ShowsAVerticalEdgeVertical) {
  const Beams beams = staggered(12.0);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  ASSERT_EQ(picture.kind, BeamPicture::Kind::grid);
  // a wall whose edge is at 30 degrees to the left: beams beyond it miss
  for (std::uint32_t row = 0; row < 2; ++row) {
    std::uint32_t edge = 1;  // the azimuth of column 0 may be 180 or -180
    while (azimuth_deg(beams, picture.beam_at(row * picture.cols + edge)) > 30.5) ++edge;
    EXPECT_EQ(edge, 150U) << "180 degrees is column 0, row " << row;
  }
  EXPECT_LT(widest_column_deg(picture, beams), 0.5) << "half a column";
}

TEST(BeamPicture, ContainsEveryBeamOfAFullRotationOnce) {
  const Beams beams = staggered(7.3);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  const std::set<std::uint32_t> shown(picture.beams.begin(), picture.beams.end());
  EXPECT_EQ(shown.size(), beams.size());
  EXPECT_EQ(*shown.rbegin(), beams.size() - 1);
  EXPECT_EQ(picture.left, 180.0);
  EXPECT_EQ(picture.right, -180.0);
}

TEST(BeamPicture, ShowsLeftOnTheLeftForBothRotationDirections) {
  for (const double step_deg : {-1.0, 1.0}) {
    const Beams beams = staggered(3.0, 360, step_deg);
    const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
    ASSERT_EQ(picture.kind, BeamPicture::Kind::grid);
    EXPECT_NEAR(azimuth_deg(beams, picture.beam_at(90)), 90.0, 1.5);
    EXPECT_NEAR(azimuth_deg(beams, picture.beam_at(270)), -90.0, 1.5);
  }
}

TEST(BeamPicture, CoversAllRowsOfASector) {
  const Beams beams = staggered(10.0, 60);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  EXPECT_EQ(picture.cols, 70U);
  EXPECT_EQ(picture.beam_at(0), BeamPicture::kNoBeam) << "the upper row starts later";
  EXPECT_EQ(picture.beam_at(10), 0U);
  EXPECT_EQ(picture.beam_at(picture.cols), 60U);
  EXPECT_NEAR(picture.left, 10.5, 1e-9);
}

TEST(BeamPicture, ContainsEveryBeamOfASectorOnceForAnyRowShift) {
  // half a step is the edge: the roundings of two rows differ there
  for (const double step_deg : {-1.0, 1.0, -360.0 / 512.0}) {
    for (const double steps : {-3.5, -0.5, 0.25, 0.5, 1.5, 2.5, 17.49999, 17.5, 17.50001}) {
      for (const std::uint32_t cols : {2U, 30U, 31U, 90U}) {
        const Beams beams = staggered(steps * step_deg, cols, step_deg);
        const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
        ASSERT_EQ(picture.kind, BeamPicture::Kind::grid);
        std::multiset<std::uint32_t> shown(picture.beams.begin(), picture.beams.end());
        shown.erase(BeamPicture::kNoBeam);
        EXPECT_EQ(shown.size(), beams.size()) << step_deg << " " << steps << " " << cols;
        EXPECT_EQ(std::set<std::uint32_t>(shown.begin(), shown.end()).size(), beams.size());
        EXPECT_LE(widest_column_deg(picture, beams), std::abs(step_deg) * 1.001);
      }
    }
  }
}

/// The sensor file of a head of five rows that measures part of a turn.
Sensor sector_sensor(const std::string& optics) {
  return parse_sensor(
      "name: sector\nrate_hz: 10\noptics: {type: spinning, columns_per_turn: 360, " + optics +
      "}\n");
}

TEST(BeamPicture, ASectorThatStartsInTheMiddleIsOneGrid) {
  const Sensor sensor = sector_sensor(
      "elevation_deg: [4, 2, 0], start_azimuth_deg: 0, azimuth_range: {from_deg: -60, to_deg: 60}");
  const Beams beams = make_beams(sensor);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  ASSERT_EQ(picture.kind, BeamPicture::Kind::grid);
  EXPECT_EQ(picture.rows, 3U);
  EXPECT_EQ(picture.cols, beams.cols);
  EXPECT_NEAR(picture.left, 60.0, 1.1);
  EXPECT_NEAR(picture.right, -60.0, 1.1);
  for (std::uint32_t col = 0; col < picture.cols; ++col) {
    const double shown_deg =
        picture.left - (col + 0.5) * (picture.left - picture.right) / picture.cols;
    EXPECT_NEAR(azimuth_deg(beams, picture.beam_at(col)), shown_deg, 0.51);
  }
}

TEST(BeamPicture, ShowsAStaggeredSectorCompletely) {
  const Sensor sensor = sector_sensor(
      "elevation_deg: [1, -1], azimuth_left_deg: [0, -0.5], start_azimuth_deg: 30, azimuth_range: "
      "{from_deg: 0, to_deg: 30}");
  const Beams beams = make_beams(sensor);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  const std::set<std::uint32_t> shown(picture.beams.begin(), picture.beams.end());
  EXPECT_GE(shown.size(), beams.size());
}

TEST(BeamPicture, PutsTheHighestRowOnTop) {
  Beams beams = staggered(0.0);
  std::rotate(beams.directions.begin(), beams.directions.begin() + 360, beams.directions.end());
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  EXPECT_GE(picture.beam_at(0), 360U);
  EXPECT_NEAR(picture.row_elevations_deg.at(0), 5.0, 1e-9);
}

TEST(BeamPicture, ShowsOusterUpright) {
  const Sensor sensor = load_sensor_file(find_sensor_file("OS1-128"));
  const Beams beams = make_beams(sensor);
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  ASSERT_EQ(picture.kind, BeamPicture::Kind::grid);
  EXPECT_EQ(picture.rows, 128U);
  EXPECT_EQ(picture.cols, 1024U);
  // a column is 0.35 degrees; the beams of a column differ by no more
  EXPECT_LT(widest_column_deg(picture, beams), 360.0 / 1024.0 + 1e-6);
}

TEST(BeamPicture, ShowsThePixelsOfACamera) {
  const Beams beams = make_beams(pinhole_from_fov(4, 3, 0.5));
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  EXPECT_EQ(picture.kind, BeamPicture::Kind::image);
  EXPECT_EQ(picture.rows, 3U);
  for (std::uint32_t i = 0; i < 12; ++i) EXPECT_EQ(picture.beam_at(i), i);
}

Beams scattered() {
  Beams beams;
  beams.rows = 1;
  beams.cols = 3;
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions = {direction_at(20.0 * kRadian, 10.0 * kRadian),
                      direction_at(-20.0 * kRadian, -10.0 * kRadian),
                      direction_at(-20.0 * kRadian, -10.0 * kRadian)};
  return beams;
}

/// The pixel at an angle.
std::size_t pixel_at(const BeamPicture& picture, double across, double up) {
  const double x = (across - picture.left) / (picture.right - picture.left) * picture.cols;
  const double y = (picture.top - up) / (picture.top - picture.bottom) * picture.rows;
  return static_cast<std::size_t>(y) * picture.cols + static_cast<std::size_t>(x);
}

TEST(BeamPicture, ShowsScatteredBeamsAtTheirDirections) {
  const Beams beams = scattered();
  const std::vector<double> range_m = {5.0, 7.0, 6.0};
  const BeamPicture picture = make_beam_picture(beams, range_m);
  ASSERT_EQ(picture.kind, BeamPicture::Kind::angles);
  EXPECT_GT(picture.left, picture.right);
  EXPECT_EQ(picture.beam_at(pixel_at(picture, 20.0, 10.0)), 0U);
  EXPECT_EQ(picture.beam_at(pixel_at(picture, -20.0, -10.0)), 2U) << "the nearest of two wins";
  EXPECT_EQ(picture.beam_at(pixel_at(picture, 0.0, 0.0)), BeamPicture::kNoBeam);
}

TEST(BeamPicture, PrefersReturnsToMisses) {
  const Beams beams = scattered();
  const std::vector<double> range_m = {5.0, 7.0, kNaN};
  const BeamPicture picture = make_beam_picture(beams, range_m);
  EXPECT_EQ(picture.beam_at(pixel_at(picture, -20.0, -10.0)), 1U);
}

TEST(BeamPicture, ShowsASingleLineScannerFromAbove) {
  Beams beams;
  beams.rows = 1;
  beams.cols = 3;
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions = {direction_at(0.0, 0.0), direction_at(90.0 * kRadian, 0.0),
                      direction_at(45.0 * kRadian, 0.0)};
  const std::vector<double> range_m = {4.0, 2.0, kNaN};
  const BeamPicture picture = make_beam_picture(beams, range_m);
  ASSERT_EQ(picture.kind, BeamPicture::Kind::top);
  EXPECT_LT(picture.left, 0.0) << "the sensor is in it";
  EXPECT_EQ(picture.beam_at(pixel_at(picture, 4.0, 0.0)), 0U);
  EXPECT_EQ(picture.beam_at(pixel_at(picture, 0.0, 2.0)), 1U);
}

TEST(BeamPicture, HasASizeForAScannerWithoutReturns) {
  Beams beams;
  beams.rows = beams.cols = 1;
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions = {direction_at(0.0, 0.0)};
  const BeamPicture picture = make_beam_picture(beams, no_returns(beams));
  EXPECT_GT(picture.cols, 100U);
  EXPECT_GT(picture.right - picture.left, 1.0);
}

}  // namespace
}  // namespace glidar

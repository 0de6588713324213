// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/windows.hpp"

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <support/error_text.hpp>

namespace glidar {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Times and elevations of the VLP-16's manual, in the order in which its lasers fire.
Spinning puck() {
  constexpr std::array<double, 16> kElevations_deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                      -7,  9, -5,  11, -3,  13, -1, 15};
  Spinning s;
  for (std::size_t i = 0; i < kElevations_deg.size(); ++i) {
    SpinningChannel channel;
    channel.elevation_rad = kElevations_deg.at(i) * kDegree;
    channel.fire_time_ns = 2304.0 * static_cast<double>(i);
    channel.ring = static_cast<std::uint16_t>(i);
    s.channels.push_back(channel);
  }
  s.firing_period_ns = 55296.0;
  return s;
}

TEST(Spinning, HasOneRowPerChannelAndOneColumnPerSequence) {
  for (const double rate_hz : {5.0, 10.0, 20.0}) {
    Spinning s = puck();
    s.rotation_hz = rate_hz;
    const FrameInterval turn = {0, std::llround(1e9 / rate_hz)};
    const Beams beams = make_beams(s, turn);
    validate(beams);
    EXPECT_EQ(beams.rows, 16U);
    EXPECT_EQ(beams.cols, static_cast<std::uint32_t>(std::ceil(1e9 / rate_hz / 55296.0)));
    EXPECT_EQ(beams.frame_id, "lidar_frame");
    EXPECT_EQ(beams.boresight, Eigen::Vector3d::UnitX());
  }
}

TEST(Spinning, FiresEachLaserAtItsTimeAndAzimuth) {
  const Beams beams = make_beams(puck(), {0, kSecond_ns / 10});
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t sequence = i % beams.cols;
    const std::size_t laser = beams.rings[i];
    // t = k 55.296 us + laser 2.304 us
    EXPECT_EQ(beams.times_ns[i], 55296U * sequence + 2304U * laser);
    const double azimuth_rad = 2.0 * std::numbers::pi * 10.0 * 1e-9 * beams.times_ns[i];
    const double elevation_rad = puck().channels[laser].elevation_rad;
    // x forward, y left, azimuth clockwise: x = R cos w cos phi, y = -R cos w sin phi
    const Eigen::Vector3d expected(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                   -std::cos(elevation_rad) * std::sin(azimuth_rad),
                                   std::sin(elevation_rad));
    EXPECT_LT((beams.directions[i] - expected).norm(), 1e-13);  // rounding of an angle below 2 pi
  }
}

/// Two loops that take turns: lasers 0 and 1, then 1 and 2.
Spinning with_loops() {
  Spinning s = puck();
  s.channels.resize(3);
  s.firing_loops = {{{0, 1}, {1000.0, 5000.0}}, {{2, 1}, {2000.0, 9000.0}}};
  return s;
}

TEST(Spinning, LoopsFireTheirChannelsInTurn) {
  const Beams beams = make_beams(with_loops(), {0, kSecond_ns / 10});
  validate(beams);
  ASSERT_EQ(beams.rows, 3U);
  const std::vector<std::vector<double>> fire_times_ns = {{1000.0, 5000.0, kNaN},
                                                          {kNaN, 9000.0, 2000.0}};
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t sequence = i % beams.cols;
    const std::size_t laser = beams.rings[i];
    const double fire_time_ns = fire_times_ns[sequence % 2][laser];
    EXPECT_EQ(beams.directions[i].hasNaN(), std::isnan(fire_time_ns)) << i;
    if (std::isnan(fire_time_ns)) continue;
    const double time_ns = 55296.0 * static_cast<double>(sequence) + fire_time_ns;
    EXPECT_EQ(beams.times_ns[i], time_ns);
    const double azimuth_rad = -2.0 * std::numbers::pi * 10.0 * 1e-9 * time_ns;
    EXPECT_LT((beams.directions[i] -
               direction_at(azimuth_rad, with_loops().channels[laser].elevation_rad))
                  .norm(),
              1e-13);
  }
}

TEST(Spinning, LoopsContinueAcrossIntervals) {
  testing::expect_windows_join(with_loops(), 0, kSecond_ns / 5);
  testing::expect_windows_join(with_loops(), -kSecond_ns / 3, kSecond_ns / 7);
}

TEST(Spinning, RefusesLoopsWithWrongChannels) {
  const auto error_with = [](const FiringLoop& loop) {
    Spinning s = puck();
    s.firing_loops = {loop};
    return error_text([&] { make_beams(s, {0, 1000}); });
  };
  EXPECT_EQ(error_with({{16}, {0.0}}),
            "optics, firing_loops, channel: 16; allowed: the index of a channel, each at most once "
            "in a loop");
  EXPECT_EQ(error_with({{1, 1}, {0.0, 0.0}}),
            "optics, firing_loops, channel: 1; allowed: the index of a channel, each at most once "
            "in a loop");
  EXPECT_EQ(error_with({{1, 2}, {0.0}}),
            "optics, firing_loops: 1; allowed: one fire time for each channel of the loop");
}

TEST(Spinning, StepsInAzimuthByRateTimesSequence) {
  const Beams beams = make_beams(puck(), {0, kSecond_ns / 10});
  const double step_rad = std::acos(std::clamp(
      beams.directions[0].head<2>().normalized().dot(beams.directions[1].head<2>().normalized()),
      -1.0, 1.0));
  EXPECT_NEAR(step_rad / kDegree, 360.0 * 10.0 * 55.296e-6, 1e-9);  // 0.199 degrees
}

TEST(Spinning, RowsHaveDecreasingElevation) {
  const Beams beams = make_beams(puck(), {0, kSecond_ns / 10});
  for (std::uint32_t row = 0; row < beams.rows; ++row) {
    const double elevation_rad = std::asin(beams.directions[std::size_t{row} * beams.cols].z());
    EXPECT_NEAR(elevation_rad / kDegree, 15.0 - 2.0 * row, 1e-12);
  }
}

TEST(Spinning, RotatesCounterclockwiseWhenConfigured) {
  Spinning s = puck();
  const Beams right = make_beams(s, {0, kSecond_ns / 10});
  s.rotation_direction = Spinning::RotationDirection::counterclockwise;
  const Beams left = make_beams(s, {0, kSecond_ns / 10});
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Eigen::Vector3d mirrored = left.directions[i].cwiseProduct(Eigen::Vector3d(1, -1, 1));
    EXPECT_LT((mirrored - right.directions[i]).norm(), 1e-13);
  }
}

TEST(Spinning, IntervalsJoinWithoutGapOrOverlap) {
  testing::expect_windows_join(puck(), 0, kSecond_ns / 5);
  testing::expect_windows_join(puck(), 3'600 * kSecond_ns + 17,
                               3'600 * kSecond_ns + kSecond_ns / 7);
  Spinning encoder = puck();
  encoder.columns_per_turn = 1000;
  encoder.rotation_hz = 7.3;
  encoder.channels[3].fire_time_ns = -4000.0;  // before its column's start
  testing::expect_windows_join(encoder, -kSecond_ns / 10, kSecond_ns / 10);
}

TEST(Spinning, ColumnsOfATurnStayAtEqualAngles) {
  Spinning s = puck();
  s.columns_per_turn = 1024;
  for (SpinningChannel& channel : s.channels) channel.fire_time_ns = 0.0;
  const Beams first = make_beams(s, {0, kSecond_ns / 10});
  const std::int64_t late_ns = 86'400 * kSecond_ns;  // a day later, at the start of a turn
  const Beams late = make_beams(s, {late_ns, late_ns + kSecond_ns / 10});
  EXPECT_EQ(first.cols, 1024U);
  EXPECT_EQ(first.times_ns[1], 97656U);  // 1 / (10 Hz x 1024)
  EXPECT_EQ(first.directions, late.directions);
  EXPECT_EQ(first.times_ns, late.times_ns);
}

TEST(Spinning, FiresOnlyInItsSector) {
  Spinning s = puck();
  s.azimuth_start_rad = -30.0 * kDegree;
  s.azimuth_width_rad = 90.0 * kDegree;
  for (SpinningChannel& channel : s.channels) channel.fire_time_ns = 0.0;
  const Beams beams = make_beams(s, {0, kSecond_ns / 10});
  EXPECT_NEAR(beams.cols, 90.0 / 360.0 * 1e8 / 55296.0, 1.0);
  for (const Eigen::Vector3d& d : beams.directions) {
    const double azimuth_deg = std::atan2(d.y(), d.x()) / kDegree;
    EXPECT_GE(azimuth_deg, -30.0 - 1e-9);
    EXPECT_LE(azimuth_deg, 60.0 + 1e-9);
  }
}

/// One channel with `columns` a turn and a sector between two sixths of a column, converted from
/// degrees as files are.
Spinning sector(std::uint32_t columns, std::int64_t from_sixths, std::int64_t to_sixths) {
  Spinning s;
  s.channels.resize(1);
  s.columns_per_turn = columns;
  const auto degrees = [&](std::int64_t sixths) {
    return static_cast<double>(sixths * 60) / static_cast<double>(columns);
  };
  s.azimuth_start_rad = degrees(from_sixths) * kDegree;
  s.azimuth_width_rad = (degrees(to_sixths) - degrees(from_sixths)) * kDegree;
  return s;
}

std::int64_t floor_sixth(std::int64_t sixths) {
  return sixths >= 0 ? sixths / 6 : -((-sixths + 5) / 6);
}

void expect_columns(Spinning s, std::int64_t from, std::int64_t to) {
  const std::int64_t frame_ns = kSecond_ns / 10;
  for (const std::int64_t frame : {0, 1, 123'457}) {
    const FrameInterval turn = {frame * frame_ns, (frame + 1) * frame_ns};
    s.start_azimuth_rad.reset();
    EXPECT_EQ(make_beams(s, turn).cols, (to - from) / 6 + 1)
        << from << " to " << to << " sixths of " << s.columns_per_turn;
    s.start_azimuth_rad = 0.0;
    EXPECT_EQ(make_beams(s, turn).cols, floor_sixth(to) + floor_sixth(-from) + 1)
        << from << " to " << to << " sixths of " << s.columns_per_turn << " from 0";
  }
}

TEST(Spinning, BothEndsOfEverySectorOfRationalStepsBelongToIt) {
  for (const std::uint32_t columns : {36U, 360U, 720U, 1024U, 1080U, 1440U, 1800U, 3600U}) {
    const std::int64_t turn = 6 * std::int64_t{columns};
    const std::int64_t stride = std::max<std::int64_t>(1, turn / 720);
    for (std::int64_t half = stride; 2 * half < turn - 6; half += stride)
      expect_columns(sector(columns, -half, half), -half, half);
    for (std::int64_t from = -turn; from < turn; from += 53 * stride)
      expect_columns(sector(columns, from, from + 6 * 17), from, from + 6 * 17);
  }
}

TEST(Spinning, AWholeTurnHasEachColumnOnce) {
  for (const std::uint32_t columns : {360U, 1024U, 1080U})
    for (const std::int64_t from : {-1080, -77, 0, 5})
      EXPECT_EQ(make_beams(sector(columns, from, from + 6 * columns), {0, kSecond_ns / 10}).cols,
                columns);
}

TEST(Spinning, ColumnsBesideTheSectorAreOutside) {
  Spinning s = sector(360, -60, 60);
  s.start_azimuth_rad = 0.0;
  s.azimuth_start_rad += 0.01 * kDegree;
  s.azimuth_width_rad -= 0.02 * kDegree;
  EXPECT_EQ(make_beams(s, {0, kSecond_ns / 10}).cols, 19U);
}

TEST(Spinning, AFrameIsOneSweepOfTheSector) {
  using Direction = Spinning::RotationDirection;
  for (const Direction direction : {Direction::clockwise, Direction::counterclockwise}) {
    for (const double fire_time_ns : {0.0, -1.0, -54'670.0, -700'000.0, 40'000.0}) {
      Spinning s = sector(1440, -540 * 6, 540 * 6);
      s.rotation_direction = direction;
      s.channels[0].fire_time_ns = fire_time_ns;
      const Beams beams = make_beams(s, {kSecond_ns / 10, kSecond_ns / 5});
      ASSERT_EQ(beams.cols, 1081U);
      const double sign = direction == Direction::clockwise ? -1.0 : 1.0;
      const double turned_deg = sign * 3600.0 * fire_time_ns * 1e-9;
      for (std::size_t i = 0; i < beams.cols; ++i) {
        const double azimuth_deg = sign * (0.25 * static_cast<double>(i) - 135.0) + turned_deg;
        ASSERT_LT((beams.directions[i] - direction_at(azimuth_deg * kDegree, 0.0)).norm(), 1e-12);
        ASSERT_NEAR(beams.times_ns[i] - beams.times_ns[0], static_cast<double>(i) * 1e8 / 1440,
                    1.0);
      }
    }
  }
}

TEST(Spinning, BeamsStartAtTheirOffsets) {
  Spinning s = puck();
  s.channels.resize(1);
  s.channels[0].origin_m = {0.1, 0.02, -0.3};
  const Beams beams = make_beams(s, {0, kSecond_ns / 10});
  const Eigen::Vector3d out =
      Eigen::Vector3d(beams.directions[500].x(), beams.directions[500].y(), 0.0).normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(out);
  const Eigen::Vector3d expected = 0.1 * out + 0.02 * left - 0.3 * Eigen::Vector3d::UnitZ();
  EXPECT_LT((beams.origins_m[500] - expected).norm(), 1e-15);
}

/// Ouster, OS1-like: 4 columns of stagger, beams that start 15.806 mm from the axis.
Spinning ouster() {
  constexpr double kBeamOrigin_m = 0.015806;
  Spinning s;
  for (int i = 0; i < 16; ++i) {
    SpinningChannel channel;
    channel.elevation_rad = (20.0 - 2.6 * i) * kDegree;
    channel.azimuth_offset_rad = -(4.21 - 2.8 * (i % 4)) * kDegree;  // theta_a = -azimuth_angle
    channel.ring = static_cast<std::uint16_t>(i);
    s.channels.push_back(channel);
  }
  s.columns_per_turn = 512;
  s.start_azimuth_rad = std::numbers::pi;
  s.beam_origin_m = kBeamOrigin_m;
  return s;
}

/// The makers' equation (ouster_core xyzlut.cpp, b_z = 0) without z_off: a point of the sensor's
/// axes from a reported range.
Eigen::Vector3d ouster_point(const Spinning& s, std::size_t channel, double column, double r) {
  const double theta_e = 2.0 * std::numbers::pi * (1.0 - column / s.columns_per_turn);
  const double theta_a = s.channels[channel].azimuth_offset_rad;
  const double phi = s.channels[channel].elevation_rad;
  const double n = s.beam_origin_m;
  const Eigen::Vector3d d(std::cos(theta_e + theta_a) * std::cos(phi),
                          std::sin(theta_e + theta_a) * std::cos(phi), std::sin(phi));
  const Eigen::Vector3d e(std::cos(theta_e), std::sin(theta_e), 0.0);
  const Eigen::Vector3d p = (r - n) * d + n * e;
  return {-p.x(), -p.y(), p.z()};
}

TEST(Ouster, RangesOfACentredSphereMatchTheClosedForm) {
  constexpr double kRadius_m = 3.0;
  const Spinning s = ouster();
  const Beams beams = make_beams(s, {0, kSecond_ns / 10});
  for (std::size_t i = 0; i < beams.size(); ++i) {
    // the beam's own way to the sphere, from |o + t d| = radius
    const Eigen::Vector3d& o = beams.origins_m[i];
    const double b = o.dot(beams.directions[i]);
    const double along_m = -b + std::sqrt(b * b - o.squaredNorm() + kRadius_m * kRadius_m);
    const double reported_m = along_m + beams.range_offset_m;
    // r = n (1 - k) + sqrt(R^2 - n^2 (1 - k^2)), k = cos(theta_a) cos(phi)
    const SpinningChannel& channel = s.channels[beams.rings[i]];
    const double n = s.beam_origin_m;
    const double k = std::cos(channel.azimuth_offset_rad) * std::cos(channel.elevation_rad);
    const double closed_m =
        n * (1.0 - k) + std::sqrt(kRadius_m * kRadius_m - n * n * (1.0 - k * k));
    ASSERT_NEAR(reported_m, closed_m, 1e-14);
    // the makers' equation puts the reported range on the sphere, at the same place
    const Eigen::Vector3d p =
        ouster_point(s, beams.rings[i], static_cast<double>(i % beams.cols), reported_m);
    ASSERT_NEAR(p.norm(), kRadius_m, 1e-14);
    ASSERT_LT((p - (o + along_m * beams.directions[i])).norm(), 1e-13);
  }
}

TEST(Spinning, RejectsNumbersOutOfRange) {
  const FrameInterval turn = {0, kSecond_ns / 10};
  EXPECT_THROW(make_beams(Spinning{}, turn), Error);  // no channels
  Spinning s = puck();
  s.firing_period_ns = 0.0;
  EXPECT_THROW(make_beams(s, turn), Error);
  s = puck();
  s.rotation_hz = -1.0;
  EXPECT_THROW(make_beams(s, turn), Error);
  s = puck();
  EXPECT_THROW(make_beams(s, {0, 5 * kSecond_ns}), Error);  // times in 32 bits
  EXPECT_THROW(make_beams(s, {10, 0}), Error);
  s.firing_period_ns = 1.0;  // more beams than memory
  EXPECT_THROW(make_beams(s, {0, kSecond_ns}), Error);
}

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/thread_pool.hpp>

#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <cmath>
#include <vector>

namespace glidar {
namespace {

TEST(MakeBeams, ErrorsNameTheSensor) {
  Sensor sensor;
  sensor.name = "front";
  RayTable table;
  table.rows = 1;
  table.cols = 1;
  table.directions = {Eigen::Vector3d::UnitX()};
  table.times_ns = {7.0};
  table.period_ns = 5.0;
  sensor.optics = table;
  EXPECT_EQ(error_text([&] { make_beams(sensor); }),
            "sensor 'front': optics, times: 7; allowed: from 0 to half a nanosecond before the "
            "period's end");
}

/// Returns at these ranges on beams that are 60 degrees from the boresight, in two rows for two
/// returns.
struct Returns {
  Beams beams;
  Frame frame;

  explicit Returns(const std::vector<double>& ranges_m) {
    beams.rows = 2;
    beams.cols = static_cast<std::uint32_t>(ranges_m.size() / 2);
    beams.returns = 2;
    beams.boresight = Eigen::Vector3d::UnitX();
    beams.directions.assign(ranges_m.size(), {0.5, std::sqrt(0.75), 0.0});
    resize(frame, ranges_m.size());
    frame.range_m = ranges_m;
    frame.intensity.assign(ranges_m.size(), 1.0F);
    frame.sigma_m.assign(ranges_m.size(), 0.1F);
    frame.status.assign(ranges_m.size(), Status::hit);
  }

  std::vector<Status> statuses(const Limits& limits) {
    ThreadPool threads(2);
    remove_returns_outside(limits, beams, threads, frame);
    return frame.status;
  }
};

TEST(RemoveReturnsOutside, JudgesEveryReturnByItsMeasuredRange) {
  Returns at({0.49, 0.5, 0.75, 1.0, 1.01, 3.0});
  const Limits limits{.near_m = 0.5, .far_m = 1.0, .along = Limits::Along::range};
  EXPECT_EQ(at.statuses(limits),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::hit,
                                 Status::too_far, Status::too_far}));
  EXPECT_TRUE(std::isnan(at.frame.range_m[0]));
  EXPECT_EQ(at.frame.intensity[4], 0.0F);
  EXPECT_EQ(at.frame.sigma_m[4], 0.0F);
  EXPECT_EQ(at.frame.range_m[3], 1.0);
}

TEST(RemoveReturnsOutside, JudgesDepthsAlongTheBoresight) {
  Returns at({0.9, 1.1, 3.9, 4.1});
  EXPECT_EQ(at.statuses({.near_m = 0.5, .far_m = 2.0, .along = Limits::Along::depth}),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::too_far}));
}

TEST(RemoveReturnsOutside, JudgesRangesAsReportedFromTheAxis) {
  Returns at({0.45, 0.46, 0.95, 0.96});
  at.beams.range_offset_m = 0.045;
  EXPECT_EQ(at.statuses({.near_m = 0.5, .far_m = 1.0, .along = Limits::Along::range}),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::too_far}));
}

TEST(RemoveReturnsOutside, KeepsTheReasonOfBeamsWithoutAReturn) {
  Returns at({kNaN, 5.0});
  at.frame.status[0] = Status::dropped;
  EXPECT_EQ(at.statuses({.far_m = 1.0, .along = Limits::Along::range}),
            (std::vector<Status>{Status::dropped, Status::too_far}));
}

TEST(ToWholeUnits, NeverRoundsOutOfTheLimits) {
  const Limits limits{.near_m = 0.5015, .far_m = 29.99, .along = Limits::Along::range};
  for (const double unit_m : {0.001, 0.002, 0.004, 0.008, 0.01}) {
    for (double range_m = limits.near_m; range_m <= limits.far_m; range_m += 0.00037) {
      const double units = to_whole_units(limits, Limits::Along::range, range_m, unit_m);
      EXPECT_EQ(units, std::floor(units));
      EXPECT_GE(units * unit_m, limits.near_m - 1e-12) << range_m;
      EXPECT_LE(units * unit_m, limits.far_m + 1e-12) << range_m;
      EXPECT_LT(std::abs(units * unit_m - range_m), unit_m) << range_m;
    }
  }
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 29.99, 0.001), 29990.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 29.99, 0.004), 7497.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 0.5015, 0.004), 126.0);
}

TEST(ToWholeUnits, RoundsToTheNearestWhereLimitsDoNotApply) {
  const Limits limits{.near_m = 0.5, .far_m = 0.9996};
  EXPECT_EQ(to_whole_units(limits, Limits::Along::depth, 0.9996, 0.001), 999.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 0.9996, 0.001), 1000.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::depth, 3.0004, 0.001), 3000.0);
  EXPECT_EQ(to_whole_units({}, Limits::Along::depth, -0.0006, 0.001), -1.0);
  EXPECT_TRUE(std::isnan(to_whole_units(limits, Limits::Along::depth, kNaN, 0.001)));
}

/// One beam that meets a surface whose shading normal makes `cosine` with it.
float intensity(const PhongHeadlight& light, const Reflectance& reflectance, double range_m,
                float cosine) {
  Frame frame;
  resize(frame, 1);
  frame.status = {Status::hit};
  frame.ground_truth.range_m = {range_m};
  frame.ground_truth.cos_shading = {cosine};
  frame.ground_truth.reflectance = {reflectance};
  shade_phong(light, {0, 1}, frame);
  return frame.intensity[0];
}

TEST(PhongHeadlight, MatchesEquationsThreeToFive) {
  const PhongHeadlight light{.attenuation_constant = 1.5,
                             .attenuation_linear_per_m = 0.2,
                             .attenuation_quadratic_per_m2 = 0.03,
                             .ambient = 0.2};
  const Reflectance surface{.diffuse = 0.6F, .ambient = 0.5F, .specular = 0.3F, .shininess = 12.0F};
  const double d = 4.0;
  const double c = 0.8;
  const double a = 1.0 / (1.5 + 0.2 * d + 0.03 * d * d);                // (3)
  const double colour = 0.2 * 0.5 + 0.6 * c + 0.3 * std::pow(c, 12.0);  // (5)
  EXPECT_NEAR(intensity(light, surface, d, 0.8F), a * colour, 1e-6);    // (4)
}

TEST(PhongHeadlight, BackFacesHaveTheAmbientTermOnly) {
  const PhongHeadlight light{.attenuation_linear_per_m = 0.0, .attenuation_quadratic_per_m2 = 0.0};
  const Reflectance surface{.diffuse = 1.0F, .ambient = 0.5F, .specular = 1.0F, .shininess = 2.0F};
  EXPECT_FLOAT_EQ(intensity(light, surface, 3.0, -0.5F), 0.2F * 0.5F);
}

TEST(PhongHeadlight, ShininessZeroMakesTheSpecularConstant) {
  const PhongHeadlight light{
      .attenuation_linear_per_m = 0.0, .attenuation_quadratic_per_m2 = 0.0, .ambient = 0.0};
  EXPECT_FLOAT_EQ(intensity(light, {.specular = 0.4F}, 1.0, 0.3F), 0.4F);
}

TEST(PhongHeadlight, IsZeroWhereNothingIsReported) {
  Frame frame;
  resize(frame, 1);
  frame.ground_truth.range_m = {1.0};
  frame.ground_truth.cos_shading = {1.0F};
  frame.ground_truth.reflectance = {{.diffuse = 1.0F, .ambient = 1.0F, .specular = 1.0F}};
  frame.status = {Status::too_far};
  shade_phong({}, {0, 1}, frame);
  EXPECT_EQ(frame.intensity[0], 0.0F);
}

TEST(PhongHeadlight, RejectsNegativeAndUndefinedNumbers) {
  EXPECT_NO_THROW(validate(PhongHeadlight{}));
  EXPECT_THROW(validate(PhongHeadlight{.attenuation_linear_per_m = -1.0}), Error);
  EXPECT_THROW(validate(PhongHeadlight{.ambient = kNaN}), Error);
  EXPECT_THROW(validate(PhongHeadlight{.attenuation_constant = 0.0,
                                       .attenuation_linear_per_m = 0.0,
                                       .attenuation_quadratic_per_m2 = 0.0}),
               Error);
}

/// A scanner whose frames are no multiple of its firing period, so that each has beams of its own.
Sensor scanner() {
  Sensor sensor;
  sensor.rate_hz = 10.0;
  Spinning& spinning = sensor.optics.emplace<Spinning>();
  spinning.channels = {{.elevation_rad = 0.1}, {.elevation_rad = -0.1, .ring = 1}};
  spinning.firing_period_ns = 700'000.0;
  return sensor;
}

TEST(BeamCache, HasTheBeamsOfEveryFrame) {
  const Sensor sensor = scanner();
  const BeamCache cache(sensor);
  EXPECT_EQ(cache.beams()->directions, make_beams(sensor).directions);
  const Beams third = make_beams(sensor, frame_interval(sensor, 3));
  EXPECT_EQ(cache.beams(3)->directions, third.directions);
  EXPECT_NE(cache.beams(3)->directions, cache.beams()->directions);
}

TEST(BeamCache, SharesTheBeamsOfTheLatestFrameAndThoseInUse) {
  const BeamCache cache(scanner());
  const std::shared_ptr<const Beams> first = cache.beams(1);
  EXPECT_EQ(cache.beams(1), first);
  const Beams* const second = cache.beams(2).get();
  EXPECT_EQ(cache.beams(2).get(), second);
  EXPECT_EQ(cache.beams(1), first);
}

TEST(BeamCache, SharesOneSetOfBeamsAmongAllFramesOfACamera) {
  Sensor camera;
  camera.optics = pinhole_from_fov(4, 3, 0.5);
  const BeamCache cache(camera);
  EXPECT_EQ(cache.beams(17), cache.beams());
}

TEST(BeamCache, TakesTheBeamsOfFrame0WhereTheyAreKnown) {
  Beams first = make_beams(scanner());
  first.frame_id = "known";
  EXPECT_EQ(BeamCache(scanner(), first).beams()->frame_id, "known");
}

}  // namespace

}  // namespace glidar

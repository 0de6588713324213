// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/prepared_sensor.hpp>
#include <simulate/panels.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// A pulsed camera at the origin with boresight z, and panels in front of it.
struct Stage : testing::PanelScene {
  Sensor sensor;
  unsigned threads = 2;

  Stage() {
    sensor.optics = pinhole_from_fov(1, 1, 1e-3);
    sensor.lidar_equation = LidarEquation{.reference_reflectance = 0.8, .reference_range_m = 100.0};
    sensor.receiver.pulse_fwhm_s = 5e-9;
  }

  void spread(double divergence_rad, unsigned rings = 2) {
    sensor.footprint = Footprint{
        .divergence_x_rad = divergence_rad, .divergence_y_rad = divergence_rad, .rings = rings};
  }
  [[nodiscard]] Frame shoot(std::uint64_t seed = 1) const {
    const auto renderer = make_renderer(scene, {.threads = threads});
    const Beams beams = make_beams(sensor);
    const Motion motion = static_motion(scene, Pose::Identity());
    Frame frame;
    frame.seed = seed;
    testing::simulate({scene, sensor, beams, motion, *renderer}, {.normal = true}, frame);
    return frame;
  }
};

constexpr Return kFirst{Return::Order::nearest, 0};
constexpr Return kSecond{Return::Order::nearest, 1};
constexpr Return kStrongest{Return::Order::strongest, 0};
constexpr Return kLast{Return::Order::farthest, 0};

TEST(NeedsWaveform, IsFalseForBeamsOfASingleRay) {
  Stage stage;
  stage.add_wall(10.0);
  EXPECT_FALSE(needs_waveform(stage.sensor, has_mirrors(stage.scene)));
  stage.scene.materials[0].mirror = 0.5F;
  EXPECT_TRUE(needs_waveform(stage.sensor, has_mirrors(stage.scene)));
  stage.scene.materials[0].mirror = 0.0F;
  stage.sensor.receiver.returns = {kLast};
  EXPECT_TRUE(needs_waveform(stage.sensor, has_mirrors(stage.scene)));
  stage.sensor.lidar_equation.reset();
  EXPECT_FALSE(needs_waveform(stage.sensor, has_mirrors(stage.scene)));
}

TEST(SimulateWaveforms, FootprintWithoutWidthEqualsASingleRay) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(40, 30, 0.8);
  stage.sensor.lidar_equation->noise_sigma = 0.5;
  stage.add_panel({-3.0, -2.0, 90.0}, {40.0, 0.0, 40.0}, {0.0, 30.0, 2.0});
  const Frame ray = stage.shoot();
  stage.sensor.receiver.returns = {kFirst};  // of one echo, the strongest
  const Frame line = stage.shoot();
  EXPECT_EQ(ray.status, line.status);
  EXPECT_EQ(ray.intensity, line.intensity);
  EXPECT_EQ(ray.ground_truth.primitive, line.ground_truth.primitive);
  for (std::size_t i = 0; i < ray.range_m.size(); ++i) {
    if (ray.status[i] == Status::hit) {
      EXPECT_EQ(ray.range_m[i], line.range_m[i]);
    }
  }
  EXPECT_GT(std::count(line.return_source.begin(), line.return_source.end(), ReturnSource::surface),
            0);
}

TEST(SimulateWaveforms, PointsBehindTheSensorAreReportedWithoutANearLimit) {
  Stage stage;
  RayTable behind;
  behind.rows = 1;
  behind.cols = 1;
  behind.directions = {-Eigen::Vector3d::UnitX()};
  stage.sensor.optics = behind;
  stage.sensor.receiver.returns = {kFirst};
  stage.add_panel({-10.0, -5.0, -5.0}, {0.0, 10.0, 0.0}, {0.0, 0.0, 10.0});
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[0], Status::hit);
  EXPECT_NEAR(frame.range_m[0], 10.0, 1e-9);
}

// A footprint that is completely on the surface has the signal of a ray, which decreases
// with the square of the range.
TEST(SimulateWaveforms, SignalOfAnExtendedTargetDecreasesWithTheSquareOfTheRange) {
  for (const double range_m : {5.0, 20.0, 90.0}) {
    Stage stage;
    stage.spread(1e-3);
    stage.add_wall(range_m);
    const Frame frame = stage.shoot();
    EXPECT_NEAR(frame.intensity[0] * range_m * range_m, 100.0 * 100.0, 100.0 * 100.0 * 1e-5);
    EXPECT_NEAR(frame.range_m[0], range_m, 1e-6 * range_m);
    EXPECT_EQ(frame.return_source[0], ReturnSource::surface);
  }
}

// Half the signal, 3 dB, from half a footprint. The edge is between rays; six
// rings leave 5 % of the energy to the ray in the middle, which an edge at zero would cut.
TEST(SimulateWaveforms, HalfCoveredBeamsHaveHalfTheSignal) {
  Stage stage;
  stage.spread(4e-3, 6);
  stage.add_wall(50.0, 1e-4, 50.0);
  const Frame frame = stage.shoot();
  Stage whole;
  whole.spread(4e-3, 6);
  whole.add_wall(50.0);
  const double ratio = frame.intensity[0] / whole.shoot().intensity[0];
  EXPECT_NEAR(ratio, 0.5, 0.5 * 0.054 + 0.02);  // the middle ray misses
}

// A target smaller than the beam at every range falls with the fourth power.
TEST(SimulateWaveforms, SignalOfAPointTargetDecreasesWithTheFourthPowerOfTheRange) {
  // A Gaussian beam 10 m wide at 100 m, a square of 1 m; the mean over places of the square near
  // the middle, the same parts of the beam at both ranges, evens out that rays are few.
  constexpr double kSide = 1.0;
  constexpr int kPlaces = 36;
  const auto mean_signal_at = [=](double range_m) {
    const double part_m = 3.6 * 0.05 * range_m / kPlaces;
    double sum = 0.0;
    for (int place = 0; place < kPlaces * kPlaces; ++place) {
      const double x = part_m * (place % kPlaces - 0.5 * (kPlaces - 1)) - 0.5 * kSide;
      const double y = part_m * (place / kPlaces - 0.5 * (kPlaces - 1)) - 0.5 * kSide;
      Stage stage;
      stage.spread(0.1, kMaxRings);
      stage.sensor.lidar_equation->reference_range_m = 1e5;
      stage.add_panel({x, y, range_m}, {kSide, 0.0, 0.0}, {0.0, kSide, 0.0});
      sum += static_cast<double>(stage.shoot().intensity[0]);
    }
    return sum / (kPlaces * kPlaces);
  };
  const double slope = std::log(mean_signal_at(100.0) / mean_signal_at(200.0)) / std::log(2.0);
  EXPECT_NEAR(slope, 4.0, 0.01);
}

// Through the whole simulation: two half-covering walls.
TEST(SimulateWaveforms, TwoWallsAreResolvedBeyondThePulseLengthAndMergedBelow) {
  const auto ranges_of = [](double apart_m) {
    Stage stage;
    stage.spread(2e-3, 4);
    stage.sensor.receiver.returns = {kFirst, kSecond};
    stage.add_wall(20.0, -50.0, 1e-4);
    stage.add_wall(20.0 + apart_m);
    return stage.shoot();
  };
  const double limit_m = 299792458.0 * 5e-9 / 2.3548;
  const Frame apart = ranges_of(1.3 * limit_m);
  EXPECT_NEAR(apart.range_m[0], 20.0, 1e-4);
  EXPECT_NEAR(apart.range_m[1], 20.0 + 1.3 * limit_m, 1e-4);
  EXPECT_EQ(apart.ground_truth.instance[0], 0U);
  EXPECT_EQ(apart.ground_truth.instance[1], 1U);
  EXPECT_EQ(apart.return_source[1], ReturnSource::surface);

  const Frame together = ranges_of(0.7 * limit_m);
  EXPECT_GT(together.range_m[0], 20.0 + 0.2 * limit_m);
  EXPECT_LT(together.range_m[0], 20.0 + 0.5 * limit_m);
  EXPECT_EQ(together.return_source[0], ReturnSource::mixed_pixel);
  EXPECT_EQ(together.status[1], Status::no_return_of_rank);
  EXPECT_TRUE(std::isnan(together.range_m[1]));
  EXPECT_EQ(together.ground_truth.instance[1], together.ground_truth.instance[0])
      << "that of the beam";
}

// sigma_t^2 = sigma_p^2 + (2 R sigma_theta tan(theta) / c)^2, seen in the peak,
// which is lower by sigma_p / sigma of an echo that is a Gaussian.
TEST(SimulateWaveforms, EchoesOfATiltedPlaneAreWider) {
  constexpr double kTilt = 1.2;
  constexpr double kRange = 40.0;
  constexpr double kDivergence = 8e-3;
  Stage stage;
  stage.spread(kDivergence, kMaxRings);
  const Eigen::Vector3d up_the_slope(std::cos(kTilt), 0.0, std::sin(kTilt));
  stage.add_panel(Eigen::Vector3d(0.0, -50.0, kRange) - 50.0 * up_the_slope, 100.0 * up_the_slope,
                  {0.0, 100.0, 0.0});
  Stage ray;
  ray.scene = stage.scene;
  const double pulse_m = pulse_sigma_m(stage.sensor.receiver);
  const double slope_m = kRange * std::tan(kTilt) * kDivergence / 4.0;
  const double lower = pulse_m / std::hypot(pulse_m, slope_m);
  EXPECT_LT(lower, 0.9);  // the effect is there to be seen
  EXPECT_NEAR(stage.shoot().intensity[0] / ray.shoot().intensity[0], lower, 0.02 * lower);
}

TEST(SimulateWaveforms, FirstStrongestAndLastAreReported) {
  Stage stage;
  stage.spread(4e-3, 4);
  stage.add_wall(20.0, 0.025, 50.0);  // a little of the beam
  stage.add_wall(25.0, -50.0, 0.02);
  stage.add_wall(80.0);
  stage.sensor.receiver.returns = {kFirst, kStrongest, kLast};
  const Frame frame = stage.shoot();
  EXPECT_NEAR(frame.range_m[0], 20.0, 1e-3);
  EXPECT_NEAR(frame.range_m[1], 25.0, 1e-3);
  EXPECT_EQ(frame.rows, 3U);
}

TEST(SimulateWaveforms, NoiseAloneIsNotAnEchoOfASurface) {
  Stage stage;
  stage.sensor.lidar_equation->noise_sigma = 0.4;  // passes the threshold once in 150 beams
  stage.sensor.receiver.returns = {kLast};
  stage.sensor.optics = pinhole_from_fov(100, 100, 1e-3);
  stage.add_wall(1000.0);  // a signal of 0.01
  const Frame frame = stage.shoot();
  EXPECT_EQ(std::count(frame.status.begin(), frame.status.end(), Status::below_threshold), 10000);
}

TEST(SimulateWaveforms, AnEchoTooCloseToAStrongerOneIsHidden) {
  Stage stage;
  stage.spread(2e-3, 4);
  stage.add_wall(20.0, 5e-3, 50.0);  // a little less than half of the beam
  stage.add_wall(21.5);
  stage.sensor.receiver.returns = {kFirst, kSecond};
  EXPECT_EQ(stage.shoot().status[1], Status::hit);
  stage.sensor.receiver.min_return_separation_m = 2.0;
  const Frame frame = stage.shoot();
  EXPECT_NEAR(frame.range_m[0], 21.5, 1e-3);
  EXPECT_EQ(frame.status[1], Status::no_return_of_rank);
}

TEST(SimulateWaveforms, ASingleEchoHasNoSecondReturn) {
  Stage stage;
  stage.add_wall(20.0);
  stage.sensor.receiver.returns = {kSecond};
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[0], Status::no_return_of_rank);
  EXPECT_EQ(frame.ground_truth.instance[0], 0U) << "the ground truth is that of the beam";
}

TEST(SimulateWaveforms, TooNearTakesPrecedenceOverSaturated) {
  Stage stage;
  stage.add_wall(5.0);
  stage.sensor.limits.near_m = 8.0;
  stage.sensor.lidar_equation->saturation = 100.0;
  EXPECT_EQ(stage.shoot().status[0], Status::too_near);
  stage.spread(1e-3);
  EXPECT_EQ(stage.shoot().status[0], Status::too_near);
  stage.sensor.limits.near_m = 0.0;
  EXPECT_EQ(stage.shoot().status[0], Status::saturated);
}

/// A mirror under 45 degrees at 10 m that sends beams along x, to a wall 5 m on.
Stage mirror_stage() {
  Stage stage;
  Material& mirror = stage.add_panel({-2.0, -2.0, 8.0}, {4.0, 0.0, 4.0}, {0.0, 4.0, 0.0});
  mirror.mirror = 0.8F;
  mirror.diffuse.setConstant(0.0F);
  stage.add_panel({5.0, -20.0, -10.0}, {0.0, 0.0, 40.0}, {0.0, 40.0, 0.0});
  return stage;
}

TEST(SimulateWaveforms, GhostOfAMirrorHasTheRangeOfTheWholePath) {
  const Frame frame = mirror_stage().shoot();
  ASSERT_EQ(frame.status[0], Status::hit);
  EXPECT_NEAR(frame.range_m[0], 15.0, 1e-5);
  EXPECT_EQ(frame.return_source[0], ReturnSource::ghost);
  EXPECT_EQ(frame.ground_truth.instance[0], 0U) << "the ground truth is the mirror";
  EXPECT_NEAR(frame.ground_truth.range_m[0], 10.0, 1e-9);
  // the path includes the mirror twice; the incidence on the wall is normal, with the reflectance
  // of the reference
  const double expected = 0.8 * 0.8 * std::pow(100.0 / 15.0, 2.0);
  EXPECT_NEAR(frame.intensity[0], expected, 1e-5 * expected);
}

// The receiver does not see near surfaces, but it sees them through a distant mirror.
TEST(SimulateWaveforms, GhostUsesTheOverlapAtTheRangeOfTheWholePath) {
  Stage stage = mirror_stage();
  stage.sensor.lidar_equation->overlap = {{0.0, 0.0}, {8.0, 0.0}, {9.0, 1.0}};
  const Frame frame = stage.shoot();
  ASSERT_EQ(frame.status[0], Status::hit);
  EXPECT_EQ(frame.intensity[0], mirror_stage().shoot().intensity[0]);
}

TEST(SimulateWaveforms, MirrorAndGhostAreTwoReturns) {
  Stage stage = mirror_stage();
  stage.scene.materials[0].diffuse.setConstant(0.1F);
  stage.sensor.receiver.returns = {kFirst, kLast};
  const Frame frame = stage.shoot();
  EXPECT_NEAR(frame.range_m[0], 10.0, 1e-9);
  EXPECT_EQ(frame.return_source[0], ReturnSource::surface);
  EXPECT_NEAR(frame.range_m[1], 15.0, 1e-5);
  EXPECT_EQ(frame.return_source[1], ReturnSource::ghost);
}

TEST(SimulateWaveforms, MirrorWithoutAReflectionIsLost) {
  Stage stage = mirror_stage();
  stage.scene.instances.pop_back();
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[0], Status::below_threshold);
  EXPECT_EQ(frame.ground_truth.instance[0], 0U);
}

TEST(SimulateWaveforms, IsIndependentOfTheNumberOfThreads) {
  Stage stage = mirror_stage();
  stage.sensor.optics = pinhole_from_fov(64, 48, 0.5);
  stage.spread(5e-3, 1);
  stage.sensor.lidar_equation->noise_sigma = 0.2;
  stage.sensor.receiver.returns = {kFirst, kStrongest};
  stage.threads = 1;
  const Frame one = stage.shoot();
  stage.threads = 3;
  const Frame three = stage.shoot();
  EXPECT_EQ(one.status, three.status);
  EXPECT_EQ(one.intensity, three.intensity);
  EXPECT_EQ(one.return_source, three.return_source);
  for (std::size_t i = 0; i < one.range_m.size(); ++i) {
    if (one.status[i] == Status::hit) {
      EXPECT_EQ(one.range_m[i], three.range_m[i]);
    }
  }
}

TEST(SimulateWaveforms, GroundTruthIsCorrectInAMovingScene) {
  // a wall that comes nearer while the pixels fire one after another
  Stage stage;
  stage.sensor.optics = LineScan{};
  stage.spread(1e-3, 1);
  stage.add_wall(20.0);
  Beams beams;
  beams.rows = 1;
  beams.cols = 3;
  beams.directions.assign(3, Eigen::Vector3d::UnitZ());
  beams.times_ns = {0, 100'000'000, 200'000'000};
  Motion motion = static_motion(stage.scene, Pose::Identity());
  motion.world_from_instance[0] = ConstantTwist{.linear_m_s = {0.0, 0.0, -10.0}};
  const auto renderer = make_renderer(stage.scene, {});
  Frame frame;
  testing::simulate({stage.scene, stage.sensor, beams, motion, *renderer}, {}, frame);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(frame.range_m[i], 20.0 - static_cast<double>(i), 1e-4);
  }
}

TEST(MakeBeams, RepeatsEveryBeamForEachReturn) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(3, 2, 0.5);
  const Beams single = make_beams(sensor);
  sensor.receiver.returns = {kFirst, kLast};
  const Beams twice = make_beams(sensor);
  EXPECT_NO_THROW(validate(twice));
  EXPECT_EQ(twice.returns, 2U);
  EXPECT_EQ(twice.rows, 4U);
  EXPECT_EQ(twice.firings(), single.size());
  for (std::size_t i = 0; i < twice.size(); ++i) {
    EXPECT_EQ(twice.directions[i], single.directions[i % 6]);
    EXPECT_EQ(twice.rings[i], i % 6 / 3);
  }
}

TEST(Simulate, AllReturnsOfAPulseHaveTheSamePointingError) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(20, 10, 0.5);
  stage.sensor.noise = {PointingJitter{.sigma_azimuth_rad = 1e-3, .sigma_elevation_rad = 1e-3}};
  stage.sensor.receiver.returns = {kFirst, kLast};
  stage.add_wall(20.0);
  const Frame frame = stage.shoot();
  const auto& aimed = frame.true_directions;
  ASSERT_EQ(aimed.size(), 400U);
  EXPECT_TRUE(std::equal(aimed.begin(), aimed.begin() + 200, aimed.begin() + 200));
}

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Radial velocities from the motion to the frame.
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/explain.hpp>
#include <simulate/velocity_stage.hpp>
#include <support/data.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;
using testing::VelocityStage;

TEST(RadialVelocityInAFrame, OfASensorThatApproachesAWallIsMinusItsSpeedTimesTheCosine) {
  VelocityStage stage;
  stage.add_wall(20.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.motion.world_from_sensor = ConstantTwist{.linear_m_s = {0.0, 0.0, 15.0}};
  const Beams beams = make_beams(stage.sensor);
  const Frame frame = stage.shoot(beams);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double expected_m_s = -15.0 * beams.directions[i].z();
    EXPECT_NEAR(frame.true_radial_velocity_m_s[i], expected_m_s, 1e-14);
    EXPECT_EQ(frame.radial_velocity_m_s[i], frame.true_radial_velocity_m_s[i]);
  }
}

TEST(RadialVelocityInAFrame, OfAStaticSceneIsExactlyZero) {
  for (const bool is_pulsed : {false, true}) {
    VelocityStage stage;
    if (is_pulsed) stage.spread(5e-3);
    stage.add_wall(20.0, -50.0, 0.1);
    stage.add_wall(20.3);
    stage.motion = static_motion(stage.scene, Pose::Identity());
    const Frame frame = stage.shoot();
    EXPECT_THAT(frame.radial_velocity_m_s, ::testing::Each(0.0));
    EXPECT_THAT(frame.true_radial_velocity_m_s, ::testing::Each(0.0));
  }
}

TEST(RadialVelocityInAFrame, OfAMissIsNaN) {
  VelocityStage stage;
  stage.add_wall(20.0, 0.0, 50.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  const Frame frame = stage.shoot();
  std::size_t hits = 0;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const bool is_hit = frame.status[i] == Status::hit;
    hits += is_hit ? 1U : 0U;
    EXPECT_EQ(std::isnan(frame.radial_velocity_m_s[i]), !is_hit);
    EXPECT_EQ(std::isnan(frame.true_radial_velocity_m_s[i]), !is_hit);
  }
  EXPECT_EQ(hits, frame.status.size() / 2);
}

TEST(RadialVelocityInAFrame, OfReturnsBeyondTheLimitsHasAGroundTruthOnly) {
  VelocityStage stage;
  stage.add_wall(20.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.sensor.limits.far_m = 10.0;
  const Frame frame = stage.shoot();
  EXPECT_THAT(frame.true_radial_velocity_m_s, ::testing::Each(0.0));
  EXPECT_THAT(frame.radial_velocity_m_s, ::testing::Each(::testing::IsNan()));
}

TEST(RadialVelocityInAFrame, IsStoredOnlyIfItIsMeasuredOrRequested) {
  VelocityStage stage;
  stage.add_wall(20.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.sensor.doppler.reset();
  const Beams beams = make_beams(stage.sensor);
  EXPECT_TRUE(stage.shoot(beams, {}).true_radial_velocity_m_s.empty());
  const Frame requested =
      stage.shoot(beams, hit_columns_for(std::vector<std::string>{"true_radial_velocity"}));
  EXPECT_TRUE(requested.radial_velocity_m_s.empty());
  EXPECT_EQ(requested.true_radial_velocity_m_s.size(), beams.size());
  stage.sensor.doppler = Doppler{};
  const Frame measured = stage.shoot(beams, {});
  EXPECT_EQ(measured.radial_velocity_m_s.size(), beams.size());
  EXPECT_EQ(measured.true_radial_velocity_m_s.size(), beams.size());
}

/// A LiDAR whose beams fire 1 ms apart, with origins of their own, on a carrier that turns, above
/// a tumbling asteroid and a sphere on a spline.
struct MovingStage : testing::VelocityStage {
  Beams beams;

  explicit MovingStage(bool is_pulsed) {
    scene = testing::scene_of(make_builtin_model("asteroid"));
    add_model(scene, make_builtin_model("sphere"));
    scene.instances[1].world_from_object.translation() << 1.2, 0.4, 0.5;
    if (is_pulsed) spread(2e-3);
    sensor.optics = pinhole_from_fov(24, 16, 0.6);
    beams = make_beams(sensor);
    for (std::uint32_t i = 0; i < beams.size(); ++i) {
      beams.times_ns.push_back(i * 1'000'000U);
      beams.origins_m.emplace_back(0.02, -0.05, 0.03);
    }
    beams.pinhole.reset();
    const Pose start = look_at({0.4, -0.3, 6.0}, {0, 0, 0}, Vector3d::UnitY());
    motion = static_motion(scene, start);
    const ConstantTwist carrier{
        .pose = start, .angular_rad_s = {0.1, -0.2, 0.3}, .linear_m_s = {0.3, 0.2, 0.4}};
    motion.world_from_sensor =
        compose_extrinsic(carrier, make_pose({0.1, 0.2, 0.0}, Eigen::Quaterniond::Identity()));
    motion.world_from_instance[0] =
        TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = {0.2, 2.0, 0.1}});
    motion.world_from_instance[1] = TimedPoses(path(), Interpolation::spline);
  }

  static std::vector<TimedPose> path() {
    std::vector<TimedPose> poses;
    for (int k = 0; k < 5; ++k) {
      poses.push_back(
          {.t_ns = k * 100'000'000, .position_m = {1.2 + 0.1 * k, 0.4 - 0.02 * k * k, 0.5}});
    }
    return poses;
  }

  /// The derivative of the range of the same material point by central differences with
  /// Richardson's extrapolation.
  [[nodiscard]] double difference_m_s(std::size_t i, const Frame& frame) const {
    const std::uint32_t hit = frame.ground_truth.instance[i];
    const Vector3d in_object = scene.instances[hit].scale * frame.ground_truth.object_point_m[i];
    const auto range_m = [&](std::int64_t t_ns) {
      return (pose_at(motion.world_from_instance[hit], t_ns) * in_object -
              pose_at(motion.world_from_sensor, t_ns) * beams.origins_m[i])
          .norm();
    };
    const auto slope = [&](std::int64_t h_ns) {
      const std::int64_t t_ns = beams.times_ns[i];
      return (range_m(t_ns + h_ns) - range_m(t_ns - h_ns)) / (2e-9 * static_cast<double>(h_ns));
    };
    return (4.0 * slope(500'000) - slope(1'000'000)) / 3.0;
  }
};

/// Rounding of 1e-15 m over 1 ms, and 1e-15 s^4 times the fifth derivative: below 1e-11 m/s. The
/// knots of the spline, where its third derivative jumps by up to 1e3 m/s^3, add 1e-6 s^2 / 6 times
/// that only to beams that fire within 1 ms of one.
constexpr double kDifference_m_s = 1e-9;

bool is_near_a_knot(std::uint32_t time_ns) {
  const std::uint32_t after_ns = time_ns % 100'000'000U;
  return after_ns <= 1'000'000U || after_ns >= 99'000'000U;
}

TEST(RadialVelocityInAFrame, IsTheDerivativeOfTheRangeOfTheSameMaterialPoint) {
  const MovingStage stage(false);
  const Frame frame = stage.shoot(stage.beams);
  std::array<int, 2> seen{};
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    if (frame.status[i] != Status::hit || is_near_a_knot(stage.beams.times_ns[i])) continue;
    ++seen.at(frame.ground_truth.instance[i]);
    EXPECT_NEAR(frame.true_radial_velocity_m_s[i], stage.difference_m_s(i, frame), kDifference_m_s)
        << i;
  }
  EXPECT_THAT(seen, ::testing::Each(::testing::Gt(15)));
}

/// The ground truth is that of the strongest sub-ray, which has its own direction.
TEST(RadialVelocityInAFrame, OfPulsesIsTheDerivativeOfTheRangeOfTheStrongestSubRay) {
  const MovingStage stage(true);
  const Frame frame = stage.shoot(stage.beams);
  int seen = 0;
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    if (frame.status[i] != Status::hit || is_near_a_knot(stage.beams.times_ns[i])) continue;
    ++seen;
    EXPECT_NEAR(frame.true_radial_velocity_m_s[i], stage.difference_m_s(i, frame), kDifference_m_s)
        << i;
  }
  EXPECT_GT(seen, 60);
}

TEST(RadialVelocityInAFrame, WithPointingErrorsIsThatOfTheBeamAsFired) {
  MovingStage stage(false);
  stage.sensor.noise = {PointingJitter{2e-3, 2e-3}};
  const Frame frame = stage.shoot(stage.beams);
  int seen = 0;
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    if (frame.status[i] != Status::hit || is_near_a_knot(stage.beams.times_ns[i])) continue;
    ++seen;
    EXPECT_NEAR(frame.true_radial_velocity_m_s[i], stage.difference_m_s(i, frame), kDifference_m_s)
        << i;
  }
  EXPECT_GT(seen, 60);
}

TEST(RadialVelocityInAFrame, NoiseStepsThatRemoveReturnsRemoveVelocities) {
  VelocityStage stage;
  stage.add_wall(20.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.sensor.noise = {Dropout{.probability = 0.5}, FalseAlarms{.rate_hz = 2e6, .far_m = 19.0}};
  stage.sensor.doppler = Doppler{.max_m_s = 8.0};
  const Frame frame = stage.shoot();
  int false_alarms = 0;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const double v = frame.radial_velocity_m_s[i];
    EXPECT_EQ(std::isnan(v), frame.status[i] != Status::hit) << i;
    if (frame.return_source[i] == ReturnSource::false_alarm) {
      ++false_alarms;
      EXPECT_NE(v, 0.0);
      EXPECT_LE(std::abs(v), 8.0);
    } else if (frame.status[i] == Status::hit) {
      EXPECT_EQ(v, 0.0);
    }
  }
  EXPECT_GT(false_alarms, 5);
}

/// Errors depend on the signal as received, which steps such as intensity_scale change afterwards.
TEST(RadialVelocityInAFrame, ErrorsDependOnTheSignalBeforeNoiseSteps) {
  VelocityStage stage;
  stage.spread(1e-3);
  stage.add_wall(20.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.sensor.doppler = Doppler{.signal_sigma_m_s = 1.0};
  const Frame plain = stage.shoot();
  stage.sensor.noise = {IntensityGaussian{.sigma = 1e6}};
  const Frame noisy = stage.shoot();
  EXPECT_NE(plain.intensity, noisy.intensity);
  EXPECT_EQ(plain.radial_velocity_m_s, noisy.radial_velocity_m_s);
}

void expect_same(const std::vector<double>& one, const std::vector<double>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_TRUE(one[i] == other[i] || (std::isnan(one[i]) && std::isnan(other[i]))) << i;
  }
}

TEST(RadialVelocityInAFrame, IsIndependentOfTheNumberOfThreads) {
  for (const bool is_pulsed : {false, true}) {
    MovingStage stage(is_pulsed);
    stage.sensor.doppler = Doppler{.sigma_m_s = 0.03, .step_m_s = 0.01, .max_m_s = 30.0};
    stage.threads = 1;
    const Frame one = stage.shoot(stage.beams);
    stage.threads = 3;
    const Frame three = stage.shoot(stage.beams);
    expect_same(one.radial_velocity_m_s, three.radial_velocity_m_s);
    expect_same(one.true_radial_velocity_m_s, three.true_radial_velocity_m_s);
  }
}

TEST(RadialVelocityInAFrame, IsTracedThroughItsErrors) {
  for (const bool is_pulsed : {false, true}) {
    MovingStage stage(is_pulsed);
    const Doppler doppler{.sigma_m_s = 0.2, .signal_sigma_m_s = 0.1, .max_m_s = 0.7};
    stage.sensor.doppler = doppler;
    stage.sensor.noise = {RangeGaussian{.sigma_m = 0.02}, Dropout{.probability = 0.3}};
    const auto renderer = make_renderer(stage.scene, {.threads = 2});
    Simulator simulator(stage.scene, std::make_shared<const BeamCache>(stage.sensor, stage.beams),
                        *renderer);
    const Frame whole = stage.shoot(stage.beams);
    std::size_t traced = 0;
    for (std::size_t entry = 0; entry < stage.beams.size(); entry += 13) {
      Frame frame;
      frame.seed = whole.seed;
      const PointTrace trace = explain(simulator, stage.motion, entry, frame);
      expect_same(frame.radial_velocity_m_s, whole.radial_velocity_m_s);
      if (!trace.velocity) {
        EXPECT_TRUE(std::isnan(whole.radial_velocity_m_s[entry]));
        continue;
      }
      ++traced;
      const double reported = reported_radial_velocity_m_s(
          doppler,
          trace.velocity->received_m_s + trace.velocity->sigma_m_s * trace.velocity->normal);
      EXPECT_EQ(trace.measured.radial_velocity_m_s, reported);
      const double last = trace.noise.back().after.radial_velocity_m_s;
      EXPECT_TRUE(last == whole.radial_velocity_m_s[entry] ||
                  (std::isnan(last) && whole.status[entry] == Status::dropped));
    }
    EXPECT_GT(traced, 5U);
  }
}

class RadialVelocityWith : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "gpu") make_renderer(Scene(), {.kind = "gpu"});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};

/// Renderers that agree on what is hit agree on its velocity.
TEST_P(RadialVelocityWith, EveryRendererIsThatOfCastRays) {
  Scene scene = testing::scene_of(make_builtin_model("torus"));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(48, 40, 0.5);
  sensor.doppler = Doppler{.sigma_m_s = 0.05};
  Motion motion = static_motion(scene, look_at({5, 0, 1}, {0, 0, 0}, Vector3d::UnitZ()));
  motion.world_from_instance[0] = ConstantTwist{.angular_rad_s = {0.3, -0.2, 2.0}};
  const auto shoot = [&](const std::string& kind) {
    Simulator simulator(scene, sensor, {.kind = kind, .threads = 2});
    Frame frame;
    simulator.simulate(motion, {}, frame);
    return frame;
  };
  const Frame rays = shoot("rays");
  const Frame other = shoot(GetParam());
  std::size_t same = 0;
  for (std::size_t i = 0; i < rays.range_m.size(); ++i) {
    if (rays.range_m[i] != other.range_m[i]) continue;
    ++same;
    EXPECT_EQ(rays.radial_velocity_m_s[i], other.radial_velocity_m_s[i]) << i;
    EXPECT_EQ(rays.true_radial_velocity_m_s[i], other.true_radial_velocity_m_s[i]) << i;
  }
  EXPECT_GT(same, 300U);
}

INSTANTIATE_TEST_SUITE_P(All, RadialVelocityWith, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar

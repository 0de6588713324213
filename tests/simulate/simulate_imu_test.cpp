// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulate_imu.hpp>

#include <glidar/core/error.hpp>
#include <glidar/motion/kinematics.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

Imu noisy_imu() {
  const InertialTriad triad = {.noise_density = 0.01,
                               .random_walk = 0.002,
                               .bias_instability = 0.003,
                               .correlation_time_s = 5.0,
                               .turn_on_bias = 0.1,
                               .scale_error = 0.01,
                               .misalignment_rad = 0.005};
  return {.rate_hz = 200.0, .gyroscope = triad, .accelerometer = triad};
}

Pose tilted() {
  return make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.8, 0.3, -0.2, 0.4));
}

Trajectory smooth_motion() {
  std::vector<TimedPose> poses;
  for (std::int64_t i = 0; i <= 30; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    const Vector3d axis = Vector3d(std::sin(t), 1.0, 0.3 * t).normalized();
    poses.push_back({.t_ns = i * kSecond / 10,
                     .position_m = {std::sin(t), t * t, std::cos(2.0 * t)},
                     .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(t, axis))});
  }
  return compose_extrinsic(TimedPoses(std::move(poses), Interpolation::spline), tilted());
}

TEST(SimulateImu, AtRestReadsGravityUpwards) {
  const ImuSamples samples = simulate_imu({}, ConstantPose{Pose::Identity()}, {}, 0, kSecond / 100);
  ASSERT_EQ(samples.t_ns.size(), 2U);
  EXPECT_EQ(samples.specific_force_m_s2[1], Vector3d(0.0, 0.0, 9.80665));
  EXPECT_EQ(samples.angular_velocity_rad_s[1], Vector3d::Zero());
  const ImuSamples turned = simulate_imu({}, ConstantPose{tilted()}, {}, 0, 1);
  EXPECT_LT(
      (turned.specific_force_m_s2[0] - tilted().linear().transpose() * Vector3d(0.0, 0.0, 9.80665))
          .norm(),
      1e-14);
}

TEST(SimulateImu, InFreeFallReadsZero) {
  const TorqueFreeRotation body({.rate_rad_s = {0.1, 0.2, 0.3}, .velocity_m_s = {7.0, 0.0, 0.0}});
  const ImuSamples samples = simulate_imu({}, body, {.gravity_m_s2 = Vector3d::Zero()}, 0, kSecond);
  for (const Vector3d& force : samples.specific_force_m_s2) EXPECT_EQ(force.norm(), 0.0);
}

TEST(SimulateImu, OnALeverArmReadsCentripetalAcceleration) {
  const Spin spin = {.pose = Pose::Identity(), .rate_rad_s = {0.0, 0.0, 3.0}};
  const Pose arm = make_pose({0.5, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  const ImuSamples samples = simulate_imu({}, compose_extrinsic(spin, arm), {}, 0, kSecond);
  for (std::size_t i = 0; i < samples.t_ns.size(); ++i) {
    EXPECT_LT((samples.specific_force_m_s2[i] - Vector3d(-4.5, 0.0, 9.80665)).norm(), 1e-12);
    EXPECT_LT((samples.angular_velocity_rad_s[i] - Vector3d(0.0, 0.0, 3.0)).norm(), 1e-15);
  }
}

/// Simpson's rule over pairs of samples; the rotation over a pair by the Magnus expansion of the
/// fourth order.
TEST(SimulateImu, IntegratedWithoutErrorsReproducesTheTrajectory) {
  Imu imu;
  imu.rate_hz = 2000.0;
  const ImuSamples s = simulate_imu(imu, smooth_motion(), {}, 0, 2 * kSecond + 1);
  const double h = 2.0 / imu.rate_hz;
  const auto acceleration = [&](std::size_t i, const Eigen::Matrix3d& rotation) -> Vector3d {
    return rotation * s.specific_force_m_s2[i] + standard_gravity_m_s2();
  };
  const auto exp = [](const Vector3d& v) -> Eigen::Matrix3d {
    return se3_exp(v, Vector3d::Zero()).linear();
  };
  Pose pose = s.ground_truth.world_from_imu.front();
  Vector3d velocity = s.ground_truth.velocity_m_s.front();
  for (std::size_t i = 0; i + 2 < s.t_ns.size(); i += 2) {
    const Vector3d& w0 = s.angular_velocity_rad_s[i];
    const Vector3d& w1 = s.angular_velocity_rad_s[i + 1];
    const Vector3d& w2 = s.angular_velocity_rad_s[i + 2];
    const Vector3d half = h / 24.0 * (5.0 * w0 + 8.0 * w1 - w2) + h * h / 48.0 * w0.cross(w1);
    const Vector3d whole = h / 6.0 * (w0 + 4.0 * w1 + w2) + h * h / 12.0 * w0.cross(w2);
    const Vector3d a0 = acceleration(i, pose.linear());
    const Vector3d a1 = acceleration(i + 1, pose.linear() * exp(half));
    const Eigen::Matrix3d rotation = pose.linear() * exp(whole);
    const Vector3d a2 = acceleration(i + 2, rotation);
    pose.translation() += h * velocity + h * h / 6.0 * (a0 + 2.0 * a1);
    velocity += h / 6.0 * (a0 + 4.0 * a1 + a2);
    pose.linear() = rotation;
  }
  const ImuSamples::GroundTruth& truth = s.ground_truth;
  EXPECT_LT((pose.matrix() - truth.world_from_imu.back().matrix()).norm(), 1e-7);
  EXPECT_LT((velocity - truth.velocity_m_s.back()).norm(), 1e-7);
}

void expect_equal(const ImuSamples& a, std::size_t i, const ImuSamples& b, std::size_t k) {
  EXPECT_EQ(a.t_ns[i], b.t_ns[k]);
  EXPECT_EQ(a.angular_velocity_rad_s[i], b.angular_velocity_rad_s[k]);
  EXPECT_EQ(a.specific_force_m_s2[i], b.specific_force_m_s2[k]);
  EXPECT_EQ(a.ground_truth.gyroscope_bias_rad_s[i], b.ground_truth.gyroscope_bias_rad_s[k]);
  EXPECT_EQ(a.ground_truth.accelerometer_bias_m_s2[i], b.ground_truth.accelerometer_bias_m_s2[k]);
}

TEST(SimulateImu, GivesTheSameBitsHoweverTheTimeIsDivided) {
  const ImuSamples whole = simulate_imu(noisy_imu(), smooth_motion(), {}, 0, 2 * kSecond);
  ASSERT_EQ(whole.t_ns.size(), 400U);
  std::size_t found = 0;
  std::int64_t from_ns = -5;
  for (std::int64_t step_ns = 1'234'567; from_ns < 2 * kSecond; step_ns = step_ns * 13 / 10) {
    const std::int64_t until_ns = std::min(from_ns + step_ns, 2 * kSecond);
    const ImuSamples part = simulate_imu(noisy_imu(), smooth_motion(), {}, from_ns, until_ns);
    for (std::size_t i = 0; i < part.t_ns.size(); ++i) expect_equal(part, i, whole, found++);
    from_ns = until_ns;
  }
  EXPECT_EQ(found, whole.t_ns.size());
}

TEST(SimulateImu, GivesTheSameBitsInAnyNumberOfThreads) {
  const ImuSamples whole = simulate_imu(noisy_imu(), smooth_motion(), {}, 0, kSecond);
  std::vector<ImuSamples> parts(8);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    threads.emplace_back([&parts, k] {
      const auto from_ns = static_cast<std::int64_t>(k) * kSecond / 8;
      parts[k] = simulate_imu(noisy_imu(), smooth_motion(), {}, from_ns, from_ns + kSecond / 8);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const ImuSamples& part : parts) {
    for (std::size_t i = 0; i < part.t_ns.size(); ++i) {
      expect_equal(part, i, whole, static_cast<std::size_t>(part.first) + i);
    }
  }
}

TEST(SimulateImu, SeedsAndImusHaveErrorsOfTheirOwn) {
  const auto first = [](const ImuRun& run) {
    return simulate_imu(noisy_imu(), ConstantPose{}, run, 0, 1).angular_velocity_rad_s[0];
  };
  EXPECT_EQ(first({.seed = 3, .imu = 1}), first({.seed = 3, .imu = 1}));
  EXPECT_NE(first({.seed = 3, .imu = 1}), first({.seed = 4, .imu = 1}));
  EXPECT_NE(first({.seed = 3, .imu = 1}), first({.seed = 3, .imu = 2}));
}

TEST(SimulateImu, SamplesLongAfterTheStartAreImmediate) {
  const ImuRun run = {.start_ns = 1'700'000'000 * kSecond};
  const std::int64_t later_ns = run.start_ns + 10'000'000 * kSecond;
  const ImuSamples samples =
      simulate_imu(noisy_imu(), ConstantPose{}, run, later_ns, later_ns + kSecond / 100);
  ASSERT_EQ(samples.t_ns.size(), 2U);
  EXPECT_EQ(samples.first, 2'000'000'000U);
  EXPECT_EQ(samples.t_ns[1], later_ns + 5'000'000);
}

TEST(SimulateImu, StartsAtItsStart) {
  EXPECT_EQ(simulate_imu({}, ConstantPose{}, {.start_ns = 100}, 0, 100).t_ns.size(), 0U);
  EXPECT_EQ(simulate_imu({}, ConstantPose{}, {.start_ns = 100}, 0, 101).t_ns.size(), 1U);
  EXPECT_EQ(simulate_imu({}, ConstantPose{}, {}, 50, 20).t_ns.size(), 0U);
}

TEST(SimulateImu, TimesAreRoundedToNanosecondsOnce) {
  Imu imu;
  imu.rate_hz = 300.0;
  const ImuSamples samples = simulate_imu(imu, ConstantPose{}, {}, 0, kSecond + 1);
  ASSERT_EQ(samples.t_ns.size(), 301U);
  EXPECT_EQ(samples.t_ns[1], 3'333'333);
  EXPECT_EQ(samples.t_ns[2], 6'666'667);
  EXPECT_EQ(samples.t_ns[300], kSecond);
}

TEST(SimulateImu, SaturatesAndQuantises) {
  Imu imu;
  imu.accelerometer.range = 9.0;
  imu.gyroscope.resolution = 0.25;
  const Spin spin = {.rate_rad_s = {0.3, -0.1, 0.6}};
  const ImuSamples samples = simulate_imu(imu, spin, {}, 0, 1);
  EXPECT_EQ(samples.specific_force_m_s2[0], Vector3d(0.0, 0.0, 9.0));
  EXPECT_EQ(samples.angular_velocity_rad_s[0], Vector3d(0.25, 0.0, 0.5));
  EXPECT_EQ(samples.ground_truth.angular_velocity_rad_s[0], Vector3d(0.3, -0.1, 0.6));
}

TEST(SimulateImu, MeasurementsAreTheDocumentedSumOfTruthAndErrors) {
  Imu imu = noisy_imu();
  imu.gyroscope.noise_density = 0.0;
  const Spin spin = {.rate_rad_s = {0.3, -0.1, 0.6}};
  const ImuSamples samples = simulate_imu(imu, spin, {}, 0, kSecond / 10);
  const ImuConstants constants = imu_constants(imu, {});
  EXPECT_GT((constants.gyroscope_matrix - Eigen::Matrix3d::Identity()).norm(), 1e-3);
  for (std::size_t i = 0; i < samples.t_ns.size(); ++i) {
    const Vector3d expected =
        constants.gyroscope_matrix * spin.rate_rad_s + samples.ground_truth.gyroscope_bias_rad_s[i];
    EXPECT_LT((samples.angular_velocity_rad_s[i] - expected).norm(), 1e-15);
  }
}

TEST(SimulateImu, RefusesInvalidArguments) {
  const auto error_of = [](const Imu& imu, const ImuRun& run, std::int64_t until_ns) {
    return error_text([&] { simulate_imu(imu, ConstantPose{}, run, 0, until_ns); });
  };
  Imu imu;
  imu.rate_hz = 0.0;
  EXPECT_THAT(error_of(imu, {}, 1), HasSubstr("imu, rate"));
  imu = {};
  imu.gyroscope.noise_density = std::nan("");
  EXPECT_THAT(error_of(imu, {}, 1), HasSubstr("imu, gyroscope, noise density"));
  EXPECT_THAT(error_of({}, {.gravity_m_s2 = Vector3d(0.0, std::nan(""), 0.0)}, 1),
              HasSubstr("gravity"));
  EXPECT_THAT(error_of({}, {}, 1'000'000 * kSecond), HasSubstr("at most 10000000"));
}

}  // namespace
}  // namespace glidar

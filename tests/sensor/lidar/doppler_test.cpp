// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/doppler.hpp>

#include <glidar/core/point_cloud.hpp>
#include <glidar/sensor/sensor.hpp>
#include <sensor/distribution.hpp>
#include <sensor/noise_stage.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

/// Returns of one velocity and intensity.
struct Stage : testing::NoiseStage {
  explicit Stage(double velocity_m_s = 0.0, double intensity = 1.0, std::uint32_t rows = 200)
      : NoiseStage(rows, 200, 30.0, intensity) {
    frame.radial_velocity_m_s.assign(beams.size(), velocity_m_s);
    frame.ground_truth.noise_scale.assign(beams.size(), 1.0F);
  }
  const std::vector<double>& measure(const Doppler& doppler) {
    measure_radial_velocities(doppler, thread_pool, frame);
    return frame.radial_velocity_m_s;
  }
};

TEST(Doppler, WithoutErrorsReportsTheVelocityItself) {
  Stage stage(-12.3456789);
  EXPECT_THAT(stage.measure({}), Each(-12.3456789));
}

/// Mean and standard deviation have the standard errors sigma / sqrt(n) and sigma / sqrt(2 n); five
/// of them are exceeded once in 1.7 million.
TEST(Doppler, ErrorsAreNormalWithTheStatedStandardDeviation) {
  constexpr double kSigma_m_s = 0.03;
  Stage stage(7.0);
  const std::vector<double> found = stage.measure({.sigma_m_s = kSigma_m_s});
  const testing::Moments m = testing::moments(found);
  EXPECT_NEAR(m.mean, 7.0, 5.0 * kSigma_m_s / std::sqrt(m.count));
  EXPECT_NEAR(m.sigma, kSigma_m_s, 5.0 * kSigma_m_s / std::sqrt(2.0 * m.count));
  std::vector<double> uniforms;
  for (const double v : found) {
    uniforms.push_back(0.5 * std::erfc(-(v - 7.0) / kSigma_m_s / std::sqrt(2.0)));
  }
  EXPECT_LT(testing::kolmogorov(uniforms), testing::kKolmogorovLimit);
  constexpr std::size_t kBins = 20;
  std::array<double, kBins> counts{};
  for (const double u : uniforms) counts.at(static_cast<std::size_t>(kBins * u)) += 1.0;
  std::array<double, kBins> expected{};
  expected.fill(m.count / kBins);
  EXPECT_LT(testing::chi_square(counts, expected), testing::chi_square_limit(kBins - 1.0));
}

TEST(Doppler, ErrorsOfWeakReturnsGrowWithTheInverseRootOfTheSignal) {
  const Doppler doppler{.sigma_m_s = 0.03, .signal_sigma_m_s = 0.4};
  for (const double signal : {1.0, 25.0, 1e4}) {
    Stage stage(0.0, signal);
    const testing::Moments m = testing::moments(stage.measure(doppler));
    const double expected = std::hypot(0.03, 0.4 / std::sqrt(signal));
    EXPECT_NEAR(m.sigma, expected, 5.0 * expected / std::sqrt(2.0 * m.count)) << signal;
    EXPECT_DOUBLE_EQ(radial_velocity_sigma_m_s(doppler, signal, 1.0), expected);
  }
}

TEST(Doppler, SurfacesScaleTheErrors) {
  Stage one(0.0);
  Stage three(0.0);
  three.frame.ground_truth.noise_scale.assign(three.beams.size(), 3.0F);
  const std::vector<double> errors = one.measure({.sigma_m_s = 0.1});
  const std::vector<double> scaled = three.measure({.sigma_m_s = 0.1});
  for (std::size_t i = 0; i < errors.size(); ++i) EXPECT_DOUBLE_EQ(scaled[i], 3.0 * errors[i]);
}

TEST(Doppler, ErrorsAreThoseOfTheTracedNormalNumbers) {
  Stage stage(2.0);
  const std::vector<double> found = stage.measure({.sigma_m_s = 0.5});
  for (const std::size_t i : {0U, 255U, 256U, 39999U}) {
    EXPECT_DOUBLE_EQ(found[i], 2.0 + 0.5 * radial_velocity_normal(stage.frame, i)) << i;
  }
}

TEST(Doppler, ErrorsDifferBetweenFramesAndSeedsAndRepeatOtherwise) {
  const auto errors = [](std::uint64_t seed, std::uint32_t number) {
    Stage stage;
    stage.frame.seed = seed;
    stage.frame.number = number;
    return stage.measure({.sigma_m_s = 1.0});
  };
  EXPECT_EQ(errors(1, 0), errors(1, 0));
  EXPECT_NE(errors(1, 0), errors(2, 0));
  EXPECT_NE(errors(1, 0), errors(1, 1));
}

TEST(Doppler, VelocitiesAreFoldedIntoTheUnambiguousInterval) {
  const Doppler doppler{.max_m_s = 20.0};
  const auto reported = [&](double v) { return reported_radial_velocity_m_s(doppler, v); };
  EXPECT_EQ(reported(19.5), 19.5);
  EXPECT_EQ(reported(20.0), -20.0);
  EXPECT_EQ(reported(-20.0), -20.0);
  EXPECT_EQ(reported(21.5), -18.5);
  EXPECT_EQ(reported(-21.5), 18.5);
  EXPECT_EQ(reported(83.0), 3.0);
  EXPECT_EQ(reported(-77.0), 3.0);
  for (const double below : {-60.0, -20.0, 20.0, 60.0}) {
    const double v = reported(std::nextafter(below, -1e9));
    EXPECT_GE(v, -20.0);
    EXPECT_LT(v, 20.0);
  }
}

TEST(Doppler, VelocitiesAreRoundedToWholeSteps) {
  const Doppler doppler{.step_m_s = 0.25, .max_m_s = 10.0};
  EXPECT_EQ(reported_radial_velocity_m_s(doppler, 1.1), 1.0);
  EXPECT_EQ(reported_radial_velocity_m_s(doppler, -1.2), -1.25);
  EXPECT_EQ(reported_radial_velocity_m_s(doppler, 9.95), -10.0) << "the next step is ambiguous";
  const double zero = reported_radial_velocity_m_s(doppler, -0.1);
  EXPECT_EQ(zero, 0.0);
  EXPECT_FALSE(std::signbit(zero));
}

TEST(Doppler, ReturnsThatNoiseRemovesHaveNoVelocity) {
  Stage stage(5.0);
  stage.measure({});
  stage.lose_beam(3);
  complete_radial_velocities({}, stage.frame);
  EXPECT_TRUE(std::isnan(stage.frame.radial_velocity_m_s[3]));
  EXPECT_EQ(stage.frame.radial_velocity_m_s[4], 5.0);
}

TEST(Doppler, VelocitiesOfFalseAlarmsAreUniformUpToTheLimit) {
  constexpr double kMax_m_s = 40.0;
  const Doppler doppler{.max_m_s = kMax_m_s};
  Stage stage(5.0);
  stage.frame.return_source.assign(stage.beams.size(), ReturnSource::false_alarm);
  stage.frame.return_source[7] = ReturnSource::crosstalk;
  complete_radial_velocities(doppler, stage.frame);
  EXPECT_EQ(stage.frame.radial_velocity_m_s[7], 5.0);
  std::vector<double> shares;
  for (const double v : stage.frame.radial_velocity_m_s) {
    EXPECT_GE(v, -kMax_m_s);
    EXPECT_LT(v, kMax_m_s);
    shares.push_back(0.5 + 0.5 * v / kMax_m_s);
  }
  EXPECT_LT(testing::kolmogorov(shares), testing::kKolmogorovLimit);
}

TEST(Doppler, WithFalseAlarmsNeedsALimit) {
  Sensor sensor;
  sensor.noise = {FalseAlarms{.rate_hz = 1e3, .far_m = 100.0}};
  EXPECT_NO_THROW(check_doppler(sensor));
  sensor.doppler = Doppler{};
  EXPECT_THAT(error_text([&] { check_doppler(sensor); }),
              AllOf(HasSubstr("no max_m_s beside the noise step 'false_alarms'"),
                    HasSubstr("add 'max_m_s: ...' to 'doppler'")));
  sensor.doppler->max_m_s = 60.0;
  EXPECT_NO_THROW(check_doppler(sensor));
}

TEST(Doppler, ColumnsThatTheSensorDoesNotMeasureAreRefusedByName) {
  Sensor sensor;
  sensor.name = "my lidar";
  const std::vector<std::string> named = {"xyz", "radial_velocity"};
  EXPECT_THAT(error_text([&] { check_columns(sensor, named); }),
              AllOf(HasSubstr("the sensor 'my lidar' does not measure it"),
                    HasSubstr("true_radial_velocity")));
  const std::vector<std::string> truth = {"xyz", "true_radial_velocity"};
  EXPECT_NO_THROW(check_columns(sensor, truth));
  EXPECT_NO_THROW(check_columns(sensor, cloud_column_names()));
  sensor.doppler = Doppler{};
  EXPECT_NO_THROW(check_columns(sensor, named));
}

TEST(Doppler, OfAGroundTruthSensorHasNoErrors) {
  Sensor sensor;
  EXPECT_FALSE(ground_truth_sensor(sensor).doppler.has_value());
  sensor.doppler = Doppler{.sigma_m_s = 0.1, .step_m_s = 0.5, .max_m_s = 9.0};
  const Sensor exact = ground_truth_sensor(sensor);
  ASSERT_TRUE(exact.doppler.has_value());
  EXPECT_EQ(exact.doppler->sigma_m_s, 0.0);
  EXPECT_EQ(exact.doppler->step_m_s, 0.0);
  EXPECT_TRUE(std::isinf(exact.doppler->max_m_s));
}

}  // namespace
}  // namespace glidar

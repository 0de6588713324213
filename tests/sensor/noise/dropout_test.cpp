// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/noise_stage.hpp"

#include <numbers>

namespace glidar {
namespace {

using testing::moments;
using testing::NoiseStage;

constexpr double kLight_m_per_s = 299792458.0;

double share(const NoiseStage& stage, Status status) {
  const auto found = std::count(stage.frame.status.begin(), stage.frame.status.end(), status);
  return static_cast<double>(found) / static_cast<double>(stage.frame.status.size());
}

/// Four standard errors of a share of 300000.
double tolerance(double p) {
  return 4.0 * std::sqrt(p * (1.0 - p) / 300000.0);
}

TEST(Dropout, LosesTheStatedShare) {
  NoiseStage stage(300, 1000, 10.0);
  stage.apply({Dropout{.probability = 0.03}});
  EXPECT_NEAR(share(stage, Status::dropped), 0.03, tolerance(0.03));
  for (std::size_t i = 0; i < 1000; ++i) {
    if (stage.frame.status[i] != Status::dropped) continue;
    EXPECT_TRUE(std::isnan(stage.frame.range_m[i]));
    EXPECT_EQ(stage.frame.intensity[i], 0.0F);
    EXPECT_EQ(stage.frame.sigma_m[i], 0.0F);
  }
}

TEST(Dropout, ProbabilitiesByRangeAndIncidenceAreIndependent) {
  NoiseStage stage(300, 1000, 10.0);
  stage.frame.ground_truth.cos_incidence.assign(300000, 0.5F);  // 60 degrees
  stage.apply({Dropout{.probability = 0.1,
                       .by_range_m = {{5.0, 0.0}, {15.0, 0.4}},
                       .by_incidence_rad = {{0.0, 0.0}, {std::numbers::pi / 2.0, 0.3}}}});
  const double expected = 1.0 - 0.9 * 0.8 * 0.8;
  EXPECT_NEAR(share(stage, Status::dropped), expected, tolerance(expected));
}

TEST(Crosstalk, RangeIsUniformBeforeAnotherChannelsEcho) {
  NoiseStage stage(3, 100000, 10.0);
  for (std::size_t i = 100000; i < 200000; ++i) stage.frame.range_m[i] = 50.0;
  for (std::size_t i = 200000; i < 300000; ++i) stage.lose_beam(i);
  stage.apply({Crosstalk{.probability = 0.4, .near_m = 2.0}});
  std::vector<double> false_m;
  for (std::size_t i = 0; i < 100000; ++i) {
    if (stage.frame.range_m[i] != 10.0) false_m.push_back(stage.frame.range_m[i]);
    EXPECT_EQ(stage.frame.status[200000 + i], Status::miss);
  }
  // half of the draws choose the channel without an echo, and change nothing
  EXPECT_NEAR(static_cast<double>(false_m.size()) / 1e5, 0.2, 4.0 * std::sqrt(0.16 / 1e5));
  const auto found = moments(false_m);
  EXPECT_NEAR(found.mean, 26.0, 4.0 * found.sigma / std::sqrt(found.count));
  EXPECT_NEAR(found.sigma, 48.0 / std::sqrt(12.0), 0.3);  // four standard errors are 0.27
  EXPECT_GE(*std::min_element(false_m.begin(), false_m.end()), 2.0);
  EXPECT_LE(*std::max_element(false_m.begin(), false_m.end()), 50.0);
}

TEST(FalseAlarms, ArriveAsAPoissonProcess) {
  NoiseStage stage(300, 1000, 30.0);
  for (std::size_t i = 0; i < 150000; ++i) stage.lose_beam(i);
  const FalseAlarms step{.rate_hz = 4e5, .near_m = 1.0, .far_m = 100.0, .intensity = 0.25};
  stage.apply({step});
  const auto probability = [&](double far_m) {
    return 1.0 - std::exp(-step.rate_hz * 2.0 * (far_m - 1.0) / kLight_m_per_s);
  };
  double in_the_void = 0.0;
  double before = 0.0;
  double near_half = 0.0;
  for (std::size_t i = 0; i < 300000; ++i) {
    if (i >= 150000) {
      before += stage.frame.range_m[i] != 30.0 ? 1.0 : 0.0;
      EXPECT_LE(stage.frame.range_m[i], 30.0);
      EXPECT_EQ(stage.frame.return_source[i],
                stage.frame.range_m[i] < 30.0 ? ReturnSource::false_alarm : ReturnSource::surface);
    } else if (stage.frame.status[i] == Status::hit) {
      in_the_void += 1.0;
      near_half += stage.frame.range_m[i] < 50.0 ? 1.0 : 0.0;
      EXPECT_EQ(stage.frame.intensity[i], 0.25F);
      EXPECT_EQ(stage.frame.return_source[i], ReturnSource::false_alarm);
    } else {
      EXPECT_EQ(stage.frame.return_source[i], ReturnSource::none);
    }
  }
  const auto four_sigmas = [](double p) { return 4.0 * std::sqrt(p / 150000.0); };
  EXPECT_NEAR(in_the_void / 150000.0, probability(100.0), four_sigmas(probability(100.0)));
  EXPECT_NEAR(near_half / 150000.0, probability(50.0), four_sigmas(probability(50.0)));
  EXPECT_NEAR(before / 150000.0, probability(30.0), four_sigmas(probability(30.0)));
}

TEST(FalseAlarms, AffectTheFirstOfSeveralReturns) {
  NoiseStage stage(2, 1000, 30.0);
  stage.beams.returns = 2;
  for (std::size_t i = 0; i < 2000; ++i) stage.lose_beam(i);
  stage.apply({FalseAlarms{.rate_hz = 1e9, .far_m = 100.0}});
  EXPECT_EQ(std::count(stage.frame.status.begin(), stage.frame.status.begin() + 1000, Status::hit),
            1000);
  EXPECT_EQ(std::count(stage.frame.status.begin() + 1000, stage.frame.status.end(), Status::miss),
            1000);
}

TEST(Dropout, LeavesNoReturnSource) {
  NoiseStage stage(1, 10, 30.0);
  stage.frame.return_source.assign(10, ReturnSource::surface);
  stage.apply({Dropout{.probability = 1.0}});
  EXPECT_EQ(stage.frame.return_source, std::vector<ReturnSource>(10, ReturnSource::none));
}

TEST(IntensityGaussian, HasTheStatedSpreadAndIsNeverNegative) {
  NoiseStage stage(300, 1000, 10.0, 0.5);
  stage.apply({IntensityGaussian{.sigma = 0.01, .relative = 0.08}});
  testing::expect_normal(moments(stage.frame.intensity), 0.5, 0.05);
  stage.reset(10.0, 0.01);
  stage.apply({IntensityGaussian{.sigma = 0.1}});
  for (const float intensity : stage.frame.intensity) EXPECT_GE(intensity, 0.0F);
}

TEST(IntensityScale, ReportsDiffuseAndRetroReflectorsOnTheVendorScale) {
  const IntensityScale velodyne{.kind = IntensityScale::Kind::vendor};
  for (const auto& [reflectance, byte] : std::vector<std::pair<double, double>>{{0.0, 0.0},
                                                                                {0.104, 10.0},
                                                                                {1.0, 100.0},
                                                                                {1.0001, 101.0},
                                                                                {10.0, 178.0},
                                                                                {100.0, 255.0},
                                                                                {5000.0, 255.0}})
    EXPECT_EQ(byte_of_reflectance(velodyne, reflectance), byte) << reflectance;
  const IntensityScale livox{.kind = IntensityScale::Kind::vendor, .diffuse_counts = 150.0};
  for (const auto& [reflectance, byte] : std::vector<std::pair<double, double>>{
           {0.0, 0.0}, {0.104, 16.0}, {1.0, 150.0}, {1.0001, 151.0}, {10.0, 203.0}, {100.0, 255.0}})
    EXPECT_EQ(byte_of_reflectance(livox, reflectance), byte) << reflectance;
  const IntensityScale hesai{.kind = IntensityScale::Kind::percent};
  for (const auto& [reflectance, byte] : std::vector<std::pair<double, double>>{
           {0.0, 0.0}, {0.104, 10.0}, {1.0, 100.0}, {2.5, 250.0}, {2.6, 255.0}})
    EXPECT_EQ(byte_of_reflectance(hesai, reflectance), byte) << reflectance;
}

TEST(IntensityScale, EveryByteComesFromItsReflectance) {
  const std::array<IntensityScale, 4> scales = {
      IntensityScale{.kind = IntensityScale::Kind::vendor},
      IntensityScale{.kind = IntensityScale::Kind::vendor, .diffuse_counts = 110.0},
      IntensityScale{.kind = IntensityScale::Kind::vendor, .diffuse_counts = 150.0},
      IntensityScale{.kind = IntensityScale::Kind::percent}};
  for (const IntensityScale& scale : scales) {
    for (double byte = 0.0; byte <= 255.0; ++byte) {
      if (byte == scale.diffuse_counts + 1.0 && scale.kind == IntensityScale::Kind::vendor)
        continue;  // a reflectance just above 1, which is rounded to 1
      EXPECT_EQ(byte_of_reflectance(scale, reflectance_of_byte(scale, byte)), byte);
    }
  }
}

TEST(IntensityScale, CompensatesTheRangeWithTheExponentOfTheSensor) {
  NoiseStage stage(1, 4, 20.0, 0.125);
  stage.apply({IntensityScale{
      .kind = IntensityScale::Kind::linear, .reference_m = 10.0, .range_exponent = 3.0}});
  EXPECT_FLOAT_EQ(stage.frame.intensity[0], 1.0F);  // 0.125 at twice the distance
}

TEST(IntensityScale, ScalesAndClipsNumbers) {
  NoiseStage stage(1, 4, 20.0, 0.125);
  stage.apply(
      {IntensityScale{.kind = IntensityScale::Kind::vendor, .gain = 1.0, .reference_m = 10.0}});
  EXPECT_EQ(stage.frame.intensity[0], 50.0F);  // 0.125 at twice the distance: 0.5
  stage.reset(20.0, 3.0);
  stage.apply({IntensityScale{.gain = 0.25}});
  EXPECT_EQ(stage.frame.intensity[0], 0.75F);
  stage.reset(20.0, 3.0);
  stage.apply({IntensityScale{}});
  EXPECT_EQ(stage.frame.intensity[0], 1.0F);
  stage.reset(20.0, 3.0);
  stage.apply({IntensityScale{.kind = IntensityScale::Kind::linear, .gain = 0.5}});
  EXPECT_EQ(stage.frame.intensity[0], 1.5F);
}

}  // namespace
}  // namespace glidar

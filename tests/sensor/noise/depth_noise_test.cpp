// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include "sensor/noise_stage.hpp"

#include <numbers>

namespace glidar {
namespace {

using testing::expect_normal;
using testing::moments;
using testing::NoiseStage;

TEST(DisparityQuantization, HasOnlyTheLevelsOfWholeSteps) {
  NoiseStage stage(300, 1000, 2.0);
  for (std::size_t i = 0; i < stage.frame.range_m.size(); ++i) {
    stage.frame.range_m[i] = 0.5 + 4.5 * static_cast<double>(i) / 300000.0;
  }
  const std::vector<double> before = stage.frame.range_m;
  stage.apply({DisparityQuantization{.k_m = 351.3}});
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double z = stage.frame.range_m[i];
    EXPECT_NEAR(351.3 / z, std::round(351.3 / z), 1e-9);
    EXPECT_LE(std::abs(351.3 / z - 351.3 / before[i]), 0.5 + 1e-9);
  }
}

TEST(DisparityQuantization, LevelsAreZSquaredOverKApart) {
  // the table's steps at K = 351.3 m: 2.85, 6.40, 11.39, 25.62, 71.16 mm
  for (const auto& [z, step_mm] :
       {std::pair{1.0, 2.85}, {1.5, 6.40}, {2.0, 11.39}, {3.0, 25.62}, {5.0, 71.16}}) {
    NoiseStage stage(1, 2, z);
    const double at = std::round(351.3 / z);
    stage.frame.range_m = {351.3 / (at + 0.6), 351.3 / (at - 0.4)};
    stage.apply({DisparityQuantization{.k_m = 351.3}});
    constexpr double kOfAMiddle = 0.02;  // levels are apart by z1 z2 / K
    EXPECT_NEAR((stage.frame.range_m[1] - stage.frame.range_m[0]) * 1e3 / step_mm, 1.0, kOfAMiddle);
  }
}

TEST(DisparityQuantization, DepthsBeyondOneStepAreLost) {
  NoiseStage stage(1, 1, 1000.0);
  stage.apply({DisparityQuantization{.k_m = 351.3}});
  EXPECT_EQ(stage.frame.status[0], Status::too_far);
}

TEST(KinectV1, ReportsTheDepthsOfOpenNIsTable) {
  // shift and depth in millimetres (pcl, openni_shift_to_depth_conversion.h)
  for (const auto& [shift, z_mm] : {std::pair{200, 388.45},
                                    {400, 501.14},
                                    {600, 705.93},
                                    {700, 887.22},
                                    {800, 1193.78},
                                    {900, 1824.05},
                                    {1000, 3864.20},
                                    {1050, 8767.02}}) {
    const double step_mm = z_mm * z_mm / 345489.0;
    for (const double aside : {-0.4, 0.0, 0.4}) {  // anything within the step gives its depth
      NoiseStage stage(1, 1, (z_mm + aside * step_mm) * 1e-3);
      stage.apply({KinectV1{.sigma_steps = 0.0}});
      constexpr double kDigits_mm = 0.006;  // the table has two decimals
      EXPECT_NEAR(stage.frame.range_m[0] * 1e3, z_mm, kDigits_mm + 1e-5 * z_mm) << shift;
    }
  }
}

/// Residual disparity of a frame, in steps.
std::vector<double> residual_steps(const NoiseStage& stage, double k_m, double z_m) {
  std::vector<double> steps;
  for (const double z : stage.frame.range_m) steps.push_back(k_m / z - k_m / z_m);
  return steps;
}

TEST(KinectV1, HasTheNoiseOfRealFrames) {
  // real Kinect frames: 0.53 to 0.60 steps, independent of z from 0.5 to 2 m
  constexpr KinectV1 kKinect;
  for (const double z : {0.6, 0.8111, 1.2345, 1.777}) {
    std::vector<double> all;
    for (std::uint32_t frame = 0; frame < 10; ++frame) {
      NoiseStage stage(240, 320, z);
      stage.frame.number = frame;
      stage.apply({KinectV1{}});
      const std::vector<double> steps = residual_steps(stage, kKinect.k_m, z);
      all.insert(all.end(), steps.begin(), steps.end());
    }
    const double rms = std::hypot(moments(all).sigma, moments(all).mean);
    EXPECT_NEAR(rms, 0.53, 0.06) << z;  // the stated spread of the recordings
  }
}

TEST(KinectV1, ErrorsOfNeighboursAreThoseOfAMeanOverTheWindow) {
  // K so large that rounding does not count
  constexpr double kFine = 1e9;
  NoiseStage stage(480, 640, 1.0);
  stage.apply({KinectV1{.k_m = kFine, .offset_steps = 0.0, .sigma_steps = 1e5}});
  const std::vector<double> steps = residual_steps(stage, kFine, 1.0);
  const auto correlation = [&](std::size_t down, std::size_t right) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t row = 10; row + down < 470; ++row) {
      for (std::size_t col = 10; col + right < 630; ++col) {
        sum += steps[row * 640 + col] * steps[(row + down) * 640 + col + right];
        count += 1.0;
      }
    }
    return sum / count / 1e10;
  };
  // windows that overlap by (9 - a) (9 - b) of 81 pixels; 3500 independent patches in an image
  constexpr double kFourSigmas = 4.0 * 1.42 / 59.0;
  for (const auto& [a, b] : {std::pair{0, 0}, {0, 3}, {4, 0}, {2, 5}, {9, 0}, {0, 12}}) {
    const double theory = std::max(0, 9 - a) * std::max(0, 9 - b) / 81.0;
    EXPECT_NEAR(correlation(static_cast<std::size_t>(a), static_cast<std::size_t>(b)), theory,
                kFourSigmas)
        << a << " " << b;
  }
}

struct TableRow {
  double z_m;
  double nguyen_mm;
  double nguyen_70_mm;
  double nguyen_80_mm;
  double khoshelham_mm;
  double icl_mm;
};

constexpr std::array<TableRow, 8> kTable = {{{0.5, 1.22, 2.95, 10.27, 0.36, 0.24},
                                             {1.0, 1.88, 3.11, 8.28, 1.43, 0.95},
                                             {1.5, 3.50, 4.50, 8.72, 3.21, 2.13},
                                             {2.0, 6.06, 6.93, 10.59, 5.70, 3.80},
                                             {2.5, 9.58, 10.35, 13.63, 8.91, 5.93},
                                             {3.0, 14.04, 14.75, 17.74, 12.83, 8.54},
                                             {4.0, 25.82, 26.44, 29.02, 22.80, 15.18},
                                             {5.0, 41.40, 41.95, 44.27, 35.62, 23.72}}};
constexpr double kDigits_mm = 0.0051;  // the table has two decimals

TEST(Nguyen, SigmasMatchTheTable) {
  for (const TableRow& row : kTable) {
    const auto axial_mm = [&](double deg) {
      return 1e3 * nguyen_axial_sigma_m({}, row.z_m, deg * kDegree);
    };
    EXPECT_NEAR(axial_mm(0.0), row.nguyen_mm, kDigits_mm);
    EXPECT_NEAR(axial_mm(59.9), row.nguyen_mm, kDigits_mm);
    EXPECT_NEAR(axial_mm(70.0), row.nguyen_70_mm, kDigits_mm);
    EXPECT_NEAR(axial_mm(80.0), row.nguyen_80_mm, kDigits_mm);
  }
  for (const auto& [deg, px] : {std::pair{0.0, 0.800},
                                {30.0, 0.818},
                                {45.0, 0.835},
                                {60.0, 0.870},
                                {75.0, 0.975},
                                {85.0, 1.395}}) {
    EXPECT_NEAR(nguyen_lateral_sigma_px({}, deg * kDegree), px, 0.00051);
  }
}

TEST(Nguyen, BeamsHaveTheAxialNoiseOfTheirIncidence) {
  for (const TableRow& row : kTable) {
    for (const auto& [deg, sigma_mm] :
         {std::pair{20.0, row.nguyen_mm}, {70.0, row.nguyen_70_mm}, {80.0, row.nguyen_80_mm}}) {
      NoiseStage stage(100, 300, row.z_m);
      stage.frame.ground_truth.cos_incidence.assign(30000,
                                                    static_cast<float>(std::cos(deg * kDegree)));
      stage.apply({NguyenAxial{}});
      const double sigma_m = nguyen_axial_sigma_m({}, row.z_m, deg * kDegree);
      expect_normal(moments(stage.frame.range_m), row.z_m, sigma_m);
      EXPECT_NEAR(stage.frame.sigma_m[5] * 1e3, sigma_mm, kDigits_mm + 1e-3);
    }
  }
}

TEST(Khoshelham, BeamsHaveTheNoiseOfTheTable) {
  for (const TableRow& row : kTable) {
    NoiseStage stage(100, 300, row.z_m);
    stage.apply({Khoshelham{}});
    expect_normal(moments(stage.frame.range_m), row.z_m, 1.425e-3 * row.z_m * row.z_m);
    EXPECT_NEAR(stage.frame.sigma_m[0] * 1e3, row.khoshelham_mm, kDigits_mm);
  }
}

TEST(Depth, ErrorsOfObliqueBeamsAreErrorsOfDepth) {
  NoiseStage stage(100, 300, 2.0);
  const Eigen::Vector3d oblique(0.6, 0.0, 0.8);
  std::fill(stage.beams.directions.begin(), stage.beams.directions.end(), oblique);
  stage.apply({Khoshelham{}});
  // depth 1.6 m: the error along the beam is 1 / 0.8 of the depth's
  expect_normal(moments(stage.frame.range_m), 2.0, 1.425e-3 * 1.6 * 1.6 / 0.8);
}

TEST(IclKinect, HasTheStatedSpreadOnAPlane) {
  for (const TableRow& row : kTable) {
    std::vector<double> errors;
    // depths spread over a step, as those of a surface are
    for (int k = 0; k < 10; ++k) {
      const double z = 351.3 / (351.3 / row.z_m + k / 10.0);
      NoiseStage stage(100, 300, z);
      stage.apply({IclKinect{}});
      for (const double found : stage.frame.range_m) errors.push_back(found - z);
      EXPECT_NEAR(stage.frame.sigma_m[0] * 1e3 / row.icl_mm, 1.0, 0.05);
    }
    constexpr double kThreePercent = 0.03;  // the table linearises; and has two decimals
    EXPECT_NEAR(moments(errors).sigma * 1e3 / row.icl_mm, 1.0, kThreePercent) << row.z_m;
    EXPECT_LT(std::abs(moments(errors).mean) * 1e3, 0.05 * row.icl_mm);  // no bias
  }
}

TEST(IclKinect, ReportsWholeStepsAsTheRecordedFramesDo) {
  NoiseStage stage(100, 300, 3.25);
  stage.apply({IclKinect{}});
  double farthest = 0.0;
  for (const double z : stage.frame.range_m) {
    farthest = std::max(farthest, std::abs(351.3 / z - std::round(351.3 / z)));
  }
  EXPECT_LT(farthest, 1e-9);
}

TEST(Lateral, AnEdgeIsBlurredByTheStatedPixels) {
  NoiseStage stage(400, 200, 1.0);
  for (std::size_t i = 0; i < stage.frame.range_m.size(); ++i) {
    if (i % 200 >= 100) stage.frame.range_m[i] = 2.0;
  }
  stage.apply({NguyenLateral{}});
  // Beside the edge between columns 99 and 100, a place x columns away is in between for x from 0
  // to 1: the mean of column 99 is 1 + E[clamp(x, 0, 1)], x ~ N(0, 0.8 px)
  const auto cdf = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  const double s = 0.8;
  const auto density = [](double x) {
    return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
  };
  const double clamped = s * (density(0.0) - density(1.0 / s)) + 1.0 - cdf(1.0 / s);
  std::vector<double> column;
  for (std::size_t row = 0; row < 400; ++row) {
    column.push_back(stage.frame.range_m[row * 200 + 99]);
    EXPECT_EQ(stage.frame.range_m[row * 200 + 50], 1.0);
    EXPECT_EQ(stage.frame.range_m[row * 200 + 199], 2.0);
  }
  const auto found = moments(column);
  EXPECT_NEAR(found.mean, 1.0 + clamped, 4.0 * found.sigma / 20.0);
}

TEST(Lateral, OffsetsToPixelsWithoutDepthLoseTheReturn) {
  NoiseStage stage(200, 200, 1.0);
  for (std::size_t i = 0; i < stage.frame.range_m.size(); ++i) {
    if (i % 200 >= 100) stage.lose_beam(i);
  }
  stage.apply({NguyenLateral{}});
  double lost = 0.0;
  for (std::size_t row = 0; row < 200; ++row) {
    if (stage.frame.status[row * 200 + 99] == Status::dropped) lost += 1.0;
    EXPECT_EQ(stage.frame.status[row * 200 + 100], Status::miss);
  }
  // x > 0.5 px of N(0, 0.8 px): 26.6 %
  EXPECT_NEAR(lost / 200.0, 0.266, 4.0 * std::sqrt(0.266 * 0.734 / 200.0));
}

TEST(Stereo, ErrorGrowsWithTheSquareOfDepth) {
  const Stereo d435{.focal_px = 674.0, .baseline_m = 0.05, .sigma_px = 0.08};
  std::vector<double> logs;
  for (const auto& [z, sigma_mm] : {std::pair{1.0, 2.4}, {2.0, 9.5}, {4.0, 38.0}}) {
    NoiseStage stage(300, 1000, z);
    stage.apply({d435});
    const auto found = moments(stage.frame.range_m);
    EXPECT_NEAR(found.sigma * 1e3 / sigma_mm, 1.0, 0.02) << z;
    EXPECT_NEAR(stage.frame.sigma_m[0], z * z * 0.08 / (674.0 * 0.05), 1e-7);
    logs.push_back(std::log2(found.sigma));
  }
  constexpr double kSlope = 0.02;
  EXPECT_NEAR(logs[1] - logs[0], 2.0, kSlope);
  EXPECT_NEAR(logs[2] - logs[1], 2.0, kSlope);
}

TEST(Stereo, SubpixelStepsGiveLevels) {
  NoiseStage stage(10, 100, 3.0);
  stage.apply({Stereo{.focal_px = 674.0, .baseline_m = 0.05, .sigma_px = 0.5, .step_px = 0.125}});
  for (const double z : stage.frame.range_m) {
    const double steps = 674.0 * 0.05 / z / 0.125;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
}

}  // namespace
}  // namespace glidar

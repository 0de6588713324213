// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/tof_pictures.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

using testing::expose_noisy_scene;
using testing::expose_scene;
using testing::plain_camera;
using testing::TofTarget;

const std::vector<double> kKinectFrequencies_hz = {80e6, 16e6, 120e6};
constexpr double kUnambiguous_m = kLight_m_per_s / 16e6;  // c / (2 gcd), gcd 8 MHz: 18.74 m

TofCamera kinect_camera(TofUnwrapping unwrapping) {
  TofCamera camera = plain_camera(kKinectFrequencies_hz, 3);
  camera.decoder.unwrapping = unwrapping;
  camera.decoder.misfit_test = {.min_rad = 100.0, .max_rad = 100.0, .scale = 100.0};
  return camera;
}

TEST(TofUnwrapping, ThreeFrequenciesReachTheUnambiguousRange) {
  EXPECT_NEAR(kUnambiguous_m, 18.75, 0.02);
  constexpr std::uint32_t kRanges = 3000;
  const double step_m = kUnambiguous_m / kRanges;
  for (const TofUnwrapping method : {TofUnwrapping::best_fit, TofUnwrapping::kinect_v2}) {
    const TofCamera camera = kinect_camera(method);
    const TofImages images =
        expose_scene(camera, kRanges, 1, [&](std::uint32_t column, std::uint32_t) {
          return TofTarget{.range_m = step_m * (column + 0.5)};
        });
    const TofMeasurement measured = decode_tof(images, camera.decoder);
    for (std::uint32_t i = 0; i < kRanges; ++i) {
      ASSERT_NEAR(measured.range_m[i], step_m * (i + 0.5), 1e-5) << static_cast<int>(method);
    }
  }
}

TEST(TofUnwrapping, RangesBeyondTheUnambiguousOneWrapAround) {
  const TofCamera camera = kinect_camera(TofUnwrapping::best_fit);
  const TofImages images = expose_scene(camera, 1, 1, [](std::uint32_t, std::uint32_t) {
    return TofTarget{.range_m = kUnambiguous_m + 2.5};
  });
  EXPECT_NEAR(decode_tof(images, camera.decoder).range_m[0], 2.5, 1e-5);
}

/// The range by all combinations of whole periods, in double, with the least squares of the phases.
double brute_force_range_m(const std::array<double, 3>& turns, const std::array<double, 3>& per_m) {
  const std::array<int, 3> periods = {10, 2, 15};
  double best = std::numeric_limits<double>::infinity();
  double range_m = 0.0;
  for (int a = -1; a <= periods[0]; ++a) {
    for (int b = -1; b <= periods[1]; ++b) {
      for (int c = -1; c <= periods[2]; ++c) {
        const std::array<double, 3> t = {turns[0] + a, turns[1] + b, turns[2] + c};
        double along = 0.0;
        double squares = 0.0;
        for (std::size_t f = 0; f < 3; ++f) {
          along += t[f] * per_m[f];
          squares += per_m[f] * per_m[f];
        }
        const double r = along / squares;
        double misfit = 0.0;
        for (std::size_t f = 0; f < 3; ++f) misfit += std::pow(t[f] - r * per_m[f], 2.0);
        if (misfit >= best) continue;
        best = misfit;
        range_m = r;
      }
    }
  }
  return range_m;
}

struct WrongWraps {
  int decoded = 0;
  int brute_force = 0;
};

/// Pixels of 150 x 80 whose range is off by more than half a period of 120 MHz.
WrongWraps count_wrong_wraps(TofUnwrapping method, double electrons) {
  const TofCamera camera = kinect_camera(method);
  constexpr double kRange_m = 7.3;
  const TofImages images = expose_noisy_scene(
      camera, 150, 80,
      [&](std::uint32_t, std::uint32_t) {
        return TofTarget{.range_m = kRange_m, .electrons = electrons};
      },
      5);
  const TofMeasurement measured = decode_tof(images, camera.decoder);
  const std::size_t pixels = measured.range_m.size();
  std::array<double, 3> per_m{};
  for (std::size_t f = 0; f < 3; ++f) per_m[f] = kKinectFrequencies_hz[f] / kHalfLight_m_per_s;
  const double limit_m = 0.5 / per_m[2];
  WrongWraps wrong;
  for (std::size_t i = 0; i < pixels; ++i) {
    std::array<double, 3> turns{};
    for (std::size_t f = 0; f < 3; ++f) {
      turns[f] = static_cast<double>(measured.phase_rad[f * pixels + i]) / kTwoPi;
    }
    const bool is_right = std::abs(measured.range_m[i] - kRange_m) < limit_m;
    wrong.decoded += is_right ? 0 : 1;
    wrong.brute_force += std::abs(brute_force_range_m(turns, per_m) - kRange_m) < limit_m ? 0 : 1;
  }
  return wrong;
}

TEST(TofUnwrapping, WrongWrapsByNoiseAreAsManyAsOfAllCombinations) {
  const WrongWraps wrong = count_wrong_wraps(TofUnwrapping::best_fit, 8.4);
  EXPECT_GT(wrong.brute_force, 400);  // so that chance is below 5 %
  EXPECT_NEAR(static_cast<double>(wrong.decoded) / wrong.brute_force, 1.0, 0.1);
}

TEST(TofUnwrapping, TheKinectsOrderOfDecisionsErrsMoreOften) {
  const WrongWraps wrong = count_wrong_wraps(TofUnwrapping::kinect_v2, 6.0);
  EXPECT_GT(wrong.decoded, wrong.brute_force);  // 1018 to 976; by 24 to 42 with other seeds
  EXPECT_LT(wrong.decoded, 3 * wrong.brute_force);
}

TEST(TofUnwrapping, BestFitHasTheLeastErrorOfAllWeightings) {
  const auto spread = [](TofUnwrapping method) {
    const TofCamera camera = kinect_camera(method);
    const TofImages images = expose_noisy_scene(
        camera, 100, 100,
        [](std::uint32_t, std::uint32_t) { return TofTarget{.range_m = 2.0, .electrons = 2e4}; },
        9);
    double squares = 0.0;
    for (const double r : decode_tof(images, camera.decoder).range_m)
      squares += (r - 2.0) * (r - 2.0);
    return std::sqrt(squares / 1e4);
  };
  // sigma_R = c / (4 pi) sigma_phi / sqrt(sum f^2), and sqrt(3) sigma_phi / sum f of the mean
  // phase.
  const double sigma_phi = std::sqrt(2.0 * 2e4 / 3.0) / 2e4;
  const double scale = kLight_m_per_s / (4.0 * std::numbers::pi) * sigma_phi;
  EXPECT_NEAR(spread(TofUnwrapping::best_fit) /
                  (scale / std::sqrt(80e6 * 80e6 + 16e6 * 16e6 + 120e6 * 120e6)),
              1.0, 0.03);
  EXPECT_NEAR(spread(TofUnwrapping::kinect_v2) / (scale * std::sqrt(3.0) / 216e6), 1.0, 0.03);
}

}  // namespace
}  // namespace glidar

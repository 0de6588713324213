// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Every step's draws, held against what the step does to a frame.
#include <glidar/sensor/noise_draws.hpp>
#include <sensor/noise_stage.hpp>

#include <cmath>

namespace glidar {
namespace {

using testing::NoiseStage;

constexpr double kFrame_s = 0.1;
constexpr double kRange_m = 10.0;
constexpr std::uint32_t kRows = 8;
constexpr std::uint32_t kCols = 100;

/// Steps that do nothing, so that the step in question is not the first of its list.
std::vector<NoiseStep> after_two(const NoiseStep& step) {
  return {RangeGaussian{}, RangeQuantum{.step_m = 1e-12}, step};
}

/// Calls check(entry, draws, measured frame) for entries of a frame with one step of noise.
template <class Check>
void for_entries(const NoiseStep& step, const Check& check) {
  NoiseStage stage(kRows, kCols, kRange_m);
  stage.frame.cause.assign(stage.beams.size(), Cause::surface);
  const std::vector<NoiseStep> noise = after_two(step);
  stage.apply(noise);
  for (const std::size_t entry : {0U, 1U, 255U, 256U, 300U, 511U, 799U}) {
    check(entry, draws_of(noise, 2, stage.beams, stage.frame, kFrame_s, entry), stage.frame);
  }
}

/// A step that adds sigma times its first draw to the range.
void expect_adds(const NoiseStep& step, double sigma_m) {
  for_entries(step, [&](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
    ASSERT_EQ(draws.size(), 1U);
    EXPECT_EQ(draws[0].law, Drawn::Law::normal);
    EXPECT_NEAR(frame.range_m[entry], kRange_m + sigma_m * draws[0].value, 1e-10) << entry;
  });
}

TEST(DrawsOf, AreWhatStepsOfRangeAdd) {
  expect_adds(RangeGaussian{.sigma_m = 0.02}, 0.02);
  expect_adds(RangeSnr{.floor_m = 0.03, .k_m = 0.0, .snr_at_full_scale = 1.0}, 0.03);
  const RangePulse pulse{.pulse_fwhm_s = 5e-9, .sample_s = 1e-9, .noise = 0.01};
  expect_adds(pulse, pulse_sigma_m(pulse, 1.0));
  const RangePhotons photons{.pulse_fwhm_s = 5e-9, .photons_at_full_scale = 1e4};
  expect_adds(photons, photon_sigma_m(photons, 1.0));
  expect_adds(Khoshelham{.sigma_per_m = 1e-4}, 1e-4 * kRange_m * kRange_m);
  expect_adds(RangeBias{.offset_m = 0.0, .sigma_m = 0.05}, 0.05);
  expect_adds(RangeDrift{.sigma_m = 0.05, .tau_s = 2.0, .per_ring = true}, 0.05);
  expect_adds(RangeDrift{.sigma_m = 0.05, .tau_s = 2.0, .per_ring = false}, 0.05);
}

TEST(DrawsOf, AreWhatTheProgramOf2015Adds) {
  for (const auto law : {Range2015::Distribution::normal, Range2015::Distribution::uniform}) {
    const Range2015 step{.additive_m = 0.1, .multiplicative = 0.01, .distribution = law};
    for_entries(step, [&](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
      ASSERT_EQ(draws.size(), 2U);
      const auto spread = [](const Drawn& drawn) {
        return drawn.law == Drawn::Law::normal ? drawn.value : 2.0 * drawn.value - 1.0;
      };
      const double expected = kRange_m * (1.0 + 0.01 * spread(draws[1])) + 0.1 * spread(draws[0]);
      EXPECT_NEAR(frame.range_m[entry], expected, 1e-9) << entry;
    });
  }
}

TEST(DrawsOf, DecideWhatIsDropped) {
  for_entries(Dropout{.probability = 0.5},
              [](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
                ASSERT_EQ(draws.size(), 1U);
                EXPECT_EQ(draws[0].law, Drawn::Law::uniform);
                EXPECT_EQ(frame.status[entry] == Status::dropped, draws[0].value < 0.5) << entry;
              });
}

TEST(DrawsOf, DecideCrosstalkAndWhereItIs) {
  for_entries(Crosstalk{.probability = 0.5, .near_m = 1.0},
              [](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
                ASSERT_EQ(draws.size(), 3U);
                const bool talks = draws[0].value < 0.5;
                EXPECT_EQ(frame.cause[entry] == Cause::crosstalk, talks) << entry;
                const double expected_m = talks ? 1.0 + 9.0 * draws[2].value : kRange_m;
                EXPECT_NEAR(frame.range_m[entry], expected_m, 1e-9);
              });
}

TEST(DrawsOf, TellWhenAFalseEchoArrives) {
  constexpr double kRate_hz = 3e7;  // one in 5 m
  for_entries(FalseEchoes{.rate_hz = kRate_hz, .near_m = 0.5, .far_m = 100.0, .intensity = 1.0},
              [](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
                ASSERT_EQ(draws.size(), 1U);
                const double false_m =
                    0.5 - std::log(draws[0].value) * 0.5 * 299792458.0 / kRate_hz;
                EXPECT_NEAR(frame.range_m[entry], std::min(false_m, kRange_m), 1e-9) << entry;
              });
}

TEST(DrawsOf, AreWhatDisparityIsOffBy) {
  const Stereo stereo{.focal_px = 500.0, .baseline_m = 0.1, .sigma_px = 0.2, .step_px = 0.0};
  for_entries(stereo, [&](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
    ASSERT_EQ(draws.size(), 1U);
    const double k = 500.0 * 0.1;
    const double expected_m = k / (k / kRange_m + 0.2 * draws[0].value);
    EXPECT_NEAR(frame.range_m[entry], expected_m, 1e-9) << entry;
  });
}

TEST(DrawsOf, AreWhatIntensityIsOffBy) {
  const IntensityGaussian step{.sigma = 0.05};
  for_entries(step, [&](std::size_t entry, const std::vector<Drawn>& draws, const Frame& frame) {
    ASSERT_EQ(draws.size(), 1U);
    EXPECT_NEAR(frame.intensity[entry], 1.0 + 0.05 * draws[0].value, 1e-6) << entry;
  });
}

TEST(DrawsOf, AreErrorsOfThePhase) {
  const ContinuousWave wave{.frequencies_hz = {10e6},
                            .electrons_at_full_scale = 1e5,
                            .background_electrons = 1e4,
                            .contrast = 0.5};
  // sigma of the range: c / (4 pi f) times that of the phase, sqrt(B + A) / (sqrt 2 C A)
  const double sigma_m =
      299792458.0 / (4.0 * M_PI * 10e6) * std::sqrt(1.1e5) / (std::sqrt(2.0) * 0.5 * 1e5);
  expect_adds(wave, sigma_m);
  NoiseStage stage(1, 300, kRange_m);
  const std::vector<NoiseStep> six = {
      ContinuousWave{.frequencies_hz = {10e6, 20e6, 30e6, 40e6, 50e6, 60e6}}};
  EXPECT_EQ(draws_of(six, 0, stage.beams, stage.frame, kFrame_s, 299).size(), 6U);
}

TEST(DrawsOf, TurnBeams) {
  NoiseStage stage(2, 400, kRange_m);
  for (Eigen::Vector3d& d : stage.beams.directions) d = Eigen::Vector3d::UnitX();
  stage.beams.boresight = Eigen::Vector3d::UnitX();
  const std::vector<NoiseStep> noise = {RangeGaussian{}, PointingJitter{1e-4, 2e-4}};
  const Beams& aimed = aimed_beams(noise, stage.beams, stage.workers, stage.frame);
  for (const std::size_t entry : {0U, 255U, 256U, 777U}) {
    const auto draws = draws_of(noise, 1, stage.beams, stage.frame, kFrame_s, entry);
    ASSERT_EQ(draws.size(), 2U);
    EXPECT_NEAR(std::abs(aimed.directions[entry].y()), std::abs(1e-4 * draws[0].value), 1e-9);
    EXPECT_NEAR(aimed.directions[entry].z(), 2e-4 * draws[1].value, 1e-9);
  }
}

TEST(DrawsOf, AreNoneOfStepsThatDrawNothing) {
  const NoiseStage stage(1, 3, kRange_m);
  const std::vector<NoiseStep> noise = {RangeQuantum{}, IntensityScale{}, DisparityQuantum{}};
  for (std::size_t k = 0; k < noise.size(); ++k) {
    EXPECT_TRUE(draws_of(noise, k, stage.beams, stage.frame, kFrame_s, 0).empty());
  }
}

}  // namespace
}  // namespace glidar

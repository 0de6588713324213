// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The random numbers of every step, compared with its effect on a frame.
#include <glidar/sensor/noise/noise_trace.hpp>
#include <sensor/noise_stage.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

namespace glidar {
namespace {

using testing::NoiseStage;

constexpr double kFrame_s = 0.1;
constexpr double kRange_m = 10.0;
constexpr std::uint32_t kRows = 8;
constexpr std::uint32_t kCols = 100;

/// Steps without effect, so that the tested step is not the first of its list.
std::vector<NoiseStep> after_two(const NoiseStep& step) {
  return {RangeGaussian{}, RangeQuantization{.step_m = 1e-12}, step};
}

/// The random numbers that a step uses for an entry of a stage's frame.
std::vector<RandomSample> samples_of(NoiseStage& stage, const std::vector<NoiseStep>& noise,
                                     std::size_t step, std::size_t entry) {
  return trace_samples(plan_noise(noise, kFrame_s), stage.beams, stage.thread_pool, stage.frame,
                       entry)
      .at(step);
}

/// Calls check(entry, samples, measured frame) for entries of a frame with one step of noise.
template <class Check>
void for_entries(const NoiseStep& step, const Check& check) {
  NoiseStage before(kRows, kCols, kRange_m);
  NoiseStage stage(kRows, kCols, kRange_m);
  stage.frame.return_source.assign(stage.beams.size(), ReturnSource::surface);
  const std::vector<NoiseStep> noise = after_two(step);
  stage.apply(noise);
  for (const std::size_t entry : {0U, 1U, 255U, 256U, 300U, 511U, 799U}) {
    check(entry, samples_of(before, noise, 2, entry), stage.frame);
  }
}

/// A step that adds sigma times its first draw to the range.
void expect_adds(const NoiseStep& step, double sigma_m) {
  for_entries(
      step, [&](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
        ASSERT_EQ(samples.size(), 1U);
        EXPECT_EQ(samples[0].distribution, RandomSample::Distribution::normal);
        EXPECT_NEAR(frame.range_m[entry], kRange_m + sigma_m * samples[0].value, 1e-10) << entry;
      });
}

void expect_none(const NoiseStep& step) {
  NoiseStage stage(1, 3, kRange_m);
  EXPECT_TRUE(samples_of(stage, {step}, 0, 0).empty());
}

// One hold() for every kind of step: its random numbers explain the frame.

void hold(const RangeGaussian& /*kind*/) {
  expect_adds(RangeGaussian{.sigma_m = 0.02}, 0.02);
}
void hold(const RangeSnr& /*kind*/) {
  expect_adds(RangeSnr{.floor_m = 0.03, .k_m = 0.0, .snr_at_full_scale = 1.0}, 0.03);
}
void hold(const RangeCrlb& /*kind*/) {
  const RangeCrlb pulse{.pulse_fwhm_s = 5e-9, .sample_s = 1e-9, .noise = 0.01};
  expect_adds(pulse, pulse_sigma_m(pulse, 1.0));
}
void hold(const RangeShotNoise& /*kind*/) {
  const RangeShotNoise photons{.pulse_fwhm_s = 5e-9, .photons_at_full_scale = 1e4};
  expect_adds(photons, photon_sigma_m(photons, 1.0));
}
void hold(const Khoshelham& /*kind*/) {
  expect_adds(Khoshelham{.sigma_per_m = 1e-4}, 1e-4 * kRange_m * kRange_m);
}
void hold(const RangeBias& /*kind*/) {
  expect_adds(RangeBias{.offset_m = 0.0, .sigma_m = 0.05}, 0.05);
  expect_none(RangeBias{.offset_m = 0.1, .sigma_m = 0.0});
}
void hold(const RangeDrift& /*kind*/) {
  expect_adds(RangeDrift{.sigma_m = 0.05, .tau_s = 2.0, .per_ring = true}, 0.05);
  expect_adds(RangeDrift{.sigma_m = 0.05, .tau_s = 2.0, .per_ring = false}, 0.05);
}

void hold(const RangeQuantization& /*kind*/) {
  expect_none(RangeQuantization{.step_m = 0.1});
}
void hold(const IntensityScale& /*kind*/) {
  expect_none(IntensityScale{});
}
void hold(const DisparityQuantization& /*kind*/) {
  expect_none(DisparityQuantization{.k_m = 351.3});
}

void hold(const RangeUniform& /*kind*/) {
  for (const auto distribution :
       {RangeUniform::Distribution::normal, RangeUniform::Distribution::uniform}) {
    const RangeUniform step{
        .additive_m = 0.1, .multiplicative = 0.01, .distribution = distribution};
    for_entries(step, [&](std::size_t entry, const std::vector<RandomSample>& samples,
                          const Frame& frame) {
      ASSERT_EQ(samples.size(), 2U);
      const auto spread = [](const RandomSample& drawn) {
        return drawn.distribution == RandomSample::Distribution::normal ? drawn.value
                                                                        : 2.0 * drawn.value - 1.0;
      };
      const double expected =
          kRange_m * (1.0 + 0.01 * spread(samples[1])) + 0.1 * spread(samples[0]);
      EXPECT_NEAR(frame.range_m[entry], expected, 1e-9) << entry;
    });
  }
}

void hold(const Dropout& /*kind*/) {
  // half of them anyhow, of the others 1 / 5 at 10 m and 1 / 4 at normal incidence
  const Dropout step{.probability = 0.5,
                     .by_range_m = {{0.0, 0.0}, {20.0, 0.4}},
                     .by_incidence_rad = {{0.0, 0.25}, {1.0, 1.0}}};
  for_entries(step, [](std::size_t entry, const std::vector<RandomSample>& samples,
                       const Frame& frame) {
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_EQ(samples[0].distribution, RandomSample::Distribution::uniform);
    ASSERT_TRUE(samples[0].probability.has_value());
    EXPECT_NEAR(*samples[0].probability, 1.0 - 0.5 * 0.8 * 0.75, 1e-12);
    EXPECT_EQ(frame.status[entry] == Status::dropped, samples[0].value < *samples[0].probability)
        << entry;
  });
  NoiseStage lost(1, 1, kRange_m);
  lost.lose_beam(0);
  EXPECT_FALSE(samples_of(lost, {step}, 0, 0)[0].probability.has_value());
}

void hold(const Crosstalk& /*kind*/) {
  for_entries(Crosstalk{.probability = 0.5, .near_m = 1.0},
              [](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
                ASSERT_EQ(samples.size(), 3U);
                EXPECT_EQ(samples[0].probability, 0.5);
                const bool talks = samples[0].value < 0.5;
                EXPECT_EQ(frame.return_source[entry] == ReturnSource::crosstalk, talks) << entry;
                const double expected_m = talks ? 1.0 + 9.0 * samples[2].value : kRange_m;
                EXPECT_NEAR(frame.range_m[entry], expected_m, 1e-9);
              });
}

void hold(const FalseAlarms& /*kind*/) {
  constexpr double kRate_hz = 3e7;  // one in 5 m
  for_entries(FalseAlarms{.rate_hz = kRate_hz, .near_m = 0.5, .far_m = 100.0, .intensity = 1.0},
              [](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
                ASSERT_EQ(samples.size(), 1U);
                const double false_m =
                    0.5 - std::log(samples[0].value) * 0.5 * 299792458.0 / kRate_hz;
                EXPECT_NEAR(frame.range_m[entry], std::min(false_m, kRange_m), 1e-9) << entry;
              });
}

void hold(const Stereo& /*kind*/) {
  const Stereo stereo{.focal_px = 500.0, .baseline_m = 0.1, .sigma_px = 0.2, .step_px = 0.0};
  for_entries(stereo,
              [&](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
                ASSERT_EQ(samples.size(), 1U);
                const double k = 500.0 * 0.1;
                const double expected_m = k / (k / kRange_m + 0.2 * samples[0].value);
                EXPECT_NEAR(frame.range_m[entry], expected_m, 1e-9) << entry;
              });
}

constexpr double kFineK_m = 1e9;  // so fine that rounding is negligible

/// The range of a disparity that is off by so many of these fine steps.
double range_off_by_m(double steps) {
  return kFineK_m / (kFineK_m / kRange_m + steps);
}

/// The sum of a pixel's neighbours' own samples over the root of their number, by the window's law.
double window_mean(NoiseStage& stage, const std::vector<NoiseStep>& noise, std::size_t entry,
                   std::size_t reach) {
  double sum = 0.0;
  double count = 0.0;
  const std::size_t row = entry / kCols;
  const std::size_t col = entry % kCols;
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t c = 0; c < kCols; ++c) {
      if (r + reach < row || r > row + reach || c + reach < col || c > col + reach) continue;
      sum += samples_of(stage, noise, 2, r * kCols + c).at(0).value;
      count += 1.0;
    }
  }
  return sum / std::sqrt(count);
}

void hold(const KinectV1& /*kind*/) {
  const KinectV1 kinect{.k_m = kFineK_m, .offset_steps = 0.0, .sigma_steps = 1e5, .window = 5};
  NoiseStage before(kRows, kCols, kRange_m);
  for_entries(kinect,
              [&](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
                ASSERT_EQ(samples.size(), 2U);
                const double mean = window_mean(before, after_two(kinect), entry, 2);
                EXPECT_NEAR(samples[1].value, mean, 1e-12) << entry;
                EXPECT_NEAR(frame.range_m[entry], range_off_by_m(1e5 * mean), 1e-7) << entry;
              });
}

void hold(const NguyenAxial& /*kind*/) {
  // for_entries has no incidences, so beams hit surfaces at normal incidence
  expect_adds(NguyenAxial{}, nguyen_axial_sigma_m({}, kRange_m, 0.0));
}

constexpr double kPerCol_m = 1e-3;
constexpr double kPerRow_m = 3e-3;

/// A surface whose depth grows from pixel to pixel: what a look at the
/// place beside a pixel finds is as far off as that place is.
struct Slope : NoiseStage {
  Slope() : NoiseStage(kRows, kCols, kRange_m) {
    for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
      frame.range_m[i] +=
          kPerCol_m * static_cast<double>(i % kCols) + kPerRow_m * static_cast<double>(i / kCols);
    }
  }
};

/// The depth of the slope that a pixel sees when it looks `sigma_px` times its first two samples
/// aside, as far as the image goes.
double seen_on_slope_m(std::size_t entry, double sigma_px,
                       const std::vector<RandomSample>& samples) {
  const double col = static_cast<double>(entry % kCols) + sigma_px * samples.at(0).value;
  const double row = static_cast<double>(entry / kCols) + sigma_px * samples.at(1).value;
  return kRange_m + kPerCol_m * std::clamp(col, 0.0, kCols - 1.0) +
         kPerRow_m * std::clamp(row, 0.0, kRows - 1.0);
}

void hold(const NguyenLateral& /*kind*/) {
  const std::vector<NoiseStep> noise = {NguyenLateral{.a_px = 0.8}};
  Slope before;
  Slope stage;
  stage.apply(noise);
  for (const std::size_t entry : {0U, 99U, 150U, 255U, 256U, 799U}) {
    const auto samples = samples_of(before, noise, 0, entry);
    ASSERT_EQ(samples.size(), 2U);
    EXPECT_NEAR(stage.frame.range_m[entry], seen_on_slope_m(entry, 0.8, samples), 1e-10) << entry;
  }
}

void hold(const IclKinect& /*kind*/) {
  const std::vector<NoiseStep> noise = {
      IclKinect{.k_m = kFineK_m, .lateral_px = 0.5, .sigma_steps = 1e5}};
  Slope before;
  Slope stage;
  stage.apply(noise);
  for (const std::size_t entry : {0U, 99U, 150U, 255U, 256U, 799U}) {
    const auto samples = samples_of(before, noise, 0, entry);
    ASSERT_EQ(samples.size(), 3U);
    const double steps = kFineK_m / seen_on_slope_m(entry, 0.5, samples) + 1e5 * samples[2].value;
    EXPECT_NEAR(stage.frame.range_m[entry], kFineK_m / steps, 1e-7) << entry;
  }
}

void hold(const IntensityGaussian& /*kind*/) {
  const IntensityGaussian step{.sigma = 0.05};
  for_entries(step,
              [&](std::size_t entry, const std::vector<RandomSample>& samples, const Frame& frame) {
                ASSERT_EQ(samples.size(), 1U);
                EXPECT_NEAR(frame.intensity[entry], 1.0 + 0.05 * samples[0].value, 1e-6) << entry;
              });
}

void hold(const ContinuousWave& /*kind*/) {
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
  EXPECT_EQ(samples_of(stage, six, 0, 299).size(), 6U);
}

/// A stage of a turning sensor, all of whose beams look ahead.
struct LookingAhead : NoiseStage {
  LookingAhead() : NoiseStage(2, 400, kRange_m) {
    for (Eigen::Vector3d& d : beams.directions) d = Eigen::Vector3d::UnitX();
    beams.boresight = Eigen::Vector3d::UnitX();
  }
};

void hold(const PointingJitter& /*kind*/) {
  LookingAhead stage;
  const std::vector<NoiseStep> noise = {RangeGaussian{}, PointingJitter{1e-4, 2e-4}};
  const Beams& aimed = stage.perturb(noise);
  for (const std::size_t entry : {0U, 255U, 256U, 777U}) {
    const auto samples = samples_of(stage, noise, 1, entry);
    ASSERT_EQ(samples.size(), 2U);
    EXPECT_NEAR(std::abs(aimed.directions[entry].y()), std::abs(1e-4 * samples[0].value), 1e-9);
    EXPECT_NEAR(aimed.directions[entry].z(), 2e-4 * samples[1].value, 1e-9);
  }
}

void hold(const EncoderError& /*kind*/) {
  LookingAhead stage;
  for (const std::uint32_t frame : {0U, 1U, 77U}) {
    stage.frame.number = frame;
    const std::vector<NoiseStep> noise = {RangeGaussian{}, EncoderError{.turn_sigma_rad = 1e-3}};
    const Beams& aimed = stage.perturb(noise);
    for (const std::size_t entry : {0U, 255U, 777U}) {
      const auto samples = samples_of(stage, noise, 1, entry);
      ASSERT_EQ(samples.size(), 1U);
      EXPECT_EQ(samples[0].distribution, RandomSample::Distribution::normal);
      // reported minus true azimuth, of beams that report 0
      const Eigen::Vector3d& beam = aimed.directions[entry];
      EXPECT_NEAR(-std::atan2(beam.y(), beam.x()), 1e-3 * samples[0].value, 1e-12) << entry;
    }
  }
  expect_none(EncoderError{.step_rad = 1e-3, .eccentricity_rad = 1e-3});
}

/// The kinds of a variant as a list for a typed test.
template <class Variant>
struct KindsOf;
template <class... Kind>
struct KindsOf<std::variant<Kind...>> {
  using Types = ::testing::Types<Kind...>;
};

template <class Kind>
class DrawsOf : public ::testing::Test {};
TYPED_TEST_SUITE(DrawsOf, KindsOf<NoiseStep>::Types);

/// Does not compile when a kind of step has no hold() of its own.
TYPED_TEST(DrawsOf, AreWhatTheStepDoes) {
  hold(TypeParam{});
}

}  // namespace
}  // namespace glidar

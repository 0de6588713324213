// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Noise steps in beams per second on one core. Those with normal random numbers are compared with
// the standard library: a Mersenne twister and std::normal_distribution, added to every range.
#include "ratio_reporter.hpp"

#include <glidar/math/distributions.hpp>
#include <glidar/sensor/noise/noise.hpp>

#include <random>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kSide = 512;

/// A camera's frame on one thread; with every column that steps read.
struct Stage {
  Beams beams;
  Frame frame;
  ThreadPool thread_pool{1};

  Stage() {
    const std::size_t size = std::size_t{kSide} * kSide;
    beams.rows = kSide;
    beams.cols = kSide;
    beams.directions.assign(size, Eigen::Vector3d(0.0, 0.6, 0.8));
    resize(frame, size);
    frame.ground_truth.cos_incidence.assign(size, 0.8F);
    frame.ground_truth.noise_scale.assign(size, 1.0F);
    refill();
  }

  /// As measured; most steps move ranges a little, so that this is not needed between runs.
  void refill() {
    std::fill(frame.range_m.begin(), frame.range_m.end(), 2.5);
    std::fill(frame.intensity.begin(), frame.intensity.end(), 0.5F);
    std::fill(frame.status.begin(), frame.status.end(), Status::hit);
  }
};

void count_beams(benchmark::State& state) {
  state.counters["beams/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * kSide * kSide, benchmark::Counter::kIsRate);
}

void bench_step(const std::string& name, const std::vector<NoiseStep>& noise) {
  benchmark::RegisterBenchmark(name.c_str(), [noise](benchmark::State& state) {
    Stage stage;
    const NoisePlan plan = plan_noise(noise, 0.1);
    NoiseWorkspace workspace;
    Beams perturbed;
    for (auto _ : state) {
      stage.refill();
      benchmark::DoNotOptimize(
          &perturb_directions(plan, stage.beams, stage.frame, stage.thread_pool, perturbed));
      apply_noise(plan, stage.beams, stage.thread_pool, workspace, stage.frame);
    }
    count_beams(state);
  });
}

void bench_standard_library() {
  benchmark::RegisterBenchmark("std::normal_distribution", [](benchmark::State& state) {
    Stage stage;
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal(0.0, 0.02);
    for (auto _ : state) {
      stage.refill();
      for (double& range_m : stage.frame.range_m) range_m += normal(generator);
      benchmark::DoNotOptimize(stage.frame.range_m.data());
    }
    count_beams(state);
  });
}

/// Samples the random numbers of continuous_wave for a frame only: three normals per beam, two
/// pairs.
void draw_frame() {
  WordBatch words;
  PairBatch normals;
  for (std::uint32_t beam = 0; beam < kSide * kSide; beam += kSampleBatch) {
    sample_words({.seed = 1, .beam = beam}, words);
    box_muller(words, 0, normals);
    benchmark::DoNotOptimize(normals);
    box_muller(words, 1, normals);
    benchmark::DoNotOptimize(normals);
  }
}

void bench_draws() {
  benchmark::RegisterBenchmark("three normals a beam", [](benchmark::State& state) {
    for (auto _ : state) draw_frame();
    count_beams(state);
  });
}

void register_steps() {
  bench_step("refill and nothing", {});
  bench_step("range_gaussian", {RangeGaussian{.sigma_m = 0.02}});
  bench_step("range_snr", {RangeSnr{.floor_m = 0.01, .k_m = 0.3, .snr_at_full_scale = 250.0}});
  bench_step("range_crlb", {RangeCrlb{.pulse_fwhm_s = 5e-9, .sample_s = 1e-9, .noise = 0.01}});
  bench_step("range_shot_noise",
             {RangeShotNoise{.pulse_fwhm_s = 5e-9, .photons_at_full_scale = 1e4}});
  bench_step("range_uniform uniform", {RangeUniform{.additive_m = 0.01}});
  bench_step("range_quantization", {RangeQuantization{.step_m = 0.002}});
  bench_step("range_bias", {RangeBias{.sigma_m = 0.01}});
  bench_step("range_drift", {RangeDrift{.sigma_m = 0.01, .tau_s = 60.0}});
  bench_step("dropout", {Dropout{.probability = 0.01}});
  bench_step("crosstalk", {Crosstalk{.probability = 0.01}});
  bench_step("false_alarms", {FalseAlarms{.rate_hz = 1e4, .far_m = 100.0}});
  bench_step("disparity_quantization", {DisparityQuantization{.k_m = 351.3}});
  bench_step("khoshelham", {Khoshelham{}});
  bench_step("nguyen_axial", {NguyenAxial{}});
  bench_step("nguyen_lateral", {NguyenLateral{}});
  bench_step("icl_kinect", {IclKinect{}});
  bench_step("kinect_v1", {KinectV1{}});
  bench_step("stereo", {Stereo{.focal_px = 674.0, .baseline_m = 0.05, .sigma_px = 0.08}});
  bench_step("continuous_wave", {ContinuousWave{.frequencies_hz = {80e6, 16e6, 120e6},
                                                .electrons_at_full_scale = 2e4}});
  bench_step("continuous_wave, multipath", {ContinuousWave{.frequencies_hz = {80e6, 16e6, 120e6},
                                                           .electrons_at_full_scale = 2e4,
                                                           .multipath_fraction = 0.2}});
  bench_step("intensity_gaussian", {IntensityGaussian{.sigma = 0.01}});
  bench_step("intensity_scale unit", {IntensityScale{}});
  bench_step("intensity_scale vendor",
             {IntensityScale{.kind = IntensityScale::Kind::vendor, .reference_m = 2.0}});
  bench_step("pointing_jitter", {PointingJitter{.sigma_azimuth_rad = 1e-3}});
  bench_step("encoder_error", {EncoderError{.step_rad = 1e-4, .eccentricity_rad = 1e-4}});
  bench_step("five steps of a lidar",
             {RangeBias{.sigma_m = 0.01}, RangeSnr{.k_m = 0.3, .snr_at_full_scale = 250.0},
              Dropout{.probability = 0.01}, RangeQuantization{.step_m = 0.002},
              IntensityGaussian{.sigma = 0.01}});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  glidar::bench::bench_standard_library();
  glidar::bench::bench_draws();
  glidar::bench::register_steps();
  return glidar::bench::run(
      argc, argv,
      {{"range_gaussian / std::normal_distribution", "std::normal_distribution", "range_gaussian",
        1.5},
       {"range_snr / std::normal_distribution", "std::normal_distribution", "range_snr", 1.5}});
}

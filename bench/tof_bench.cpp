// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The time-of-flight decoder: 512x424 pixels, 3 frequencies x 3 phase steps, as for the Kinect v2.
#include "ratio_reporter.hpp"

#include <glidar/depth_camera/time_of_flight.hpp>

#include <string>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kWidth = 512;
constexpr std::uint32_t kHeight = 424;

/// The generated images, repeated to the size of a Kinect v2.
TofImages kinect_images() {
  const TofImages sample = sample_tof_images().images;
  TofImages images{kWidth, kHeight, sample.frequencies, sample.taps};
  for (std::size_t step = 0; step < std::size_t{sample.frequencies} * sample.taps; ++step) {
    const float* const from = sample.level.data() + step * pixel_count(sample);
    for (std::size_t i = 0; i < pixel_count(images); ++i) {
      const std::size_t row = i / kWidth % sample.height;
      images.level.push_back(from[row * sample.width + i % kWidth % sample.width]);
    }
  }
  return images;
}

void bench_decode(const std::string& name, const TofOptions& options, unsigned threads) {
  const auto decode = [=](benchmark::State& state) {
    const TofImages images = kinect_images();
    ThreadPool pool(threads);
    for (auto _ : state) benchmark::DoNotOptimize(decode_tof(images, options, {}, {.pool = &pool}));
  };
  benchmark::RegisterBenchmark(name.c_str(), decode)->Unit(benchmark::kMillisecond)->UseRealTime();
}

TofOptions without_filter(TofUnwrapping unwrapping) {
  TofOptions options = kinect_v2_options();
  options.unwrapping = unwrapping;
  options.filter.reset();
  options.edge_test.reset();
  return options;
}

void register_benchmarks() {
  bench_decode("kinect_v2, 1 thread", kinect_v2_options(), 1);
  bench_decode("kinect_v2, 2 threads", kinect_v2_options(), 2);
  bench_decode("kinect_v2 without filter and edges, 1 thread",
               without_filter(TofUnwrapping::kinect_v2), 1);
  bench_decode("best_fit without filter and edges, 1 thread",
               without_filter(TofUnwrapping::best_fit), 1);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  glidar::bench::register_benchmarks();
  return glidar::bench::run(
      argc, argv, {{"2 threads / 1 thread", "kinect_v2, 1 thread", "kinect_v2, 2 threads", 1.6}});
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Depth images of 848x480 pixels: each filter, the recommended ones, and the alignment to 1280x720;
// and the decoder of 12 fringe images of 1280x1024, for each number of threads.
#include "ratio_reporter.hpp"

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/depth_camera/fringes.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/depth_alignment.hpp>

#include <string>
#include <vector>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kWidth = 848;
constexpr std::uint32_t kHeight = 480;
constexpr double kBaseline_m = 0.05;

/// A slope with noise and holes.
DepthImage noisy_depths() {
  DepthImage image = {kWidth, kHeight};
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    PhiloxState words = {i, 0, 0, 0};
    philox_rounds(words, 1, 2);
    const std::uint32_t depth = 1000 + i % kWidth + words.c0 % 16;
    image.depth.push_back(static_cast<std::uint16_t>(words.c1 % 16 == 0 ? 0 : depth));
  }
  return image;
}

void bench_filters(const std::string& name, const std::vector<DepthFilter>& filters) {
  const auto filter = [=](benchmark::State& state) {
    const DepthImage image = noisy_depths();
    DepthFilterChain chain(filters, {.focal_length_px = 430.0});
    for (auto _ : state) benchmark::DoNotOptimize(chain.apply(image));
  };
  benchmark::RegisterBenchmark(name.c_str(), filter)->Unit(benchmark::kMillisecond);
}

void bench_alignment(const std::string& name, const Distortion& distortion) {
  const auto align = [=](benchmark::State& state) {
    const DepthImage image = noisy_depths();
    DepthAlignment alignment = {.depth = pinhole_from_fov(kWidth, kHeight, 1.02),
                                .colour = pinhole_from_fov(1280, 720, 0.75)};
    alignment.colour.distortion = distortion;
    alignment.colour_from_depth.translation().x() = 0.015;
    const DepthAligner aligner(alignment);
    for (auto _ : state) benchmark::DoNotOptimize(aligner.align(image));
  };
  benchmark::RegisterBenchmark(name.c_str(), align)->Unit(benchmark::kMillisecond);
}

void bench_decoder(const std::string& name, unsigned threads) {
  const auto decode = [=](benchmark::State& state) {
    const FringePatterns patterns = {.width = 1280, .height = 1024, .period_px = 160.0};
    std::vector<GreyImage> images;
    for (std::size_t i = 0; i < image_count(patterns); ++i) {
      images.push_back(make_pattern(patterns, i));
      for (std::uint16_t& level : images.back().level)
        level = static_cast<std::uint16_t>(level / 2);
    }
    ThreadPool pool(threads);
    for (auto _ : state) benchmark::DoNotOptimize(decode_fringes(images, patterns, {}, &pool));
  };
  benchmark::RegisterBenchmark(name.c_str(), decode)->Unit(benchmark::kMillisecond)->UseRealTime();
}

void register_benchmarks() {
  bench_filters("decimation", {DecimationFilter{}});
  bench_filters("spatial", {SpatialFilter{}});
  bench_filters("spatial, disparities", {ToDisparity{kBaseline_m}, SpatialFilter{}, ToDepth{}});
  bench_filters("temporal", {TemporalFilter{}});
  bench_filters("hole_filling", {HoleFillingFilter{}});
  bench_filters("recommended", recommended_depth_filters(kBaseline_m));
  bench_alignment("align", NoDistortion{});
  bench_alignment("align, lens distortion", RadialTangential{.k1 = 0.1, .k2 = -0.2});
  bench_decoder("decode, 1 thread", 1);
  bench_decoder("decode, 2 threads", 2);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  glidar::bench::register_benchmarks();
  return glidar::bench::run(argc, argv, {});
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The stereo matcher: 848x480 pixels and 128 disparities, for each instruction set and number of
// threads, with 4 and 8 paths. bench/stereo_bench.py compares it with OpenCV's.
#include "ratio_reporter.hpp"

#include <glidar/core/instruction_set.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/math/random.hpp>

#include <string>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kWidth = 848;
constexpr std::uint32_t kHeight = 480;
constexpr std::uint32_t kShift_px = 40;

/// Random levels; those of the left image are `shift` columns further right.
GreyImage shifted_levels(std::uint32_t shift) {
  GreyImage image = {.width = kWidth, .height = kHeight};
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::uint32_t column = 0; column < kWidth; ++column) {
      PhiloxState words = {column + kShift_px - shift, row, 0, 0};
      philox_rounds(words, 1, 2);
      image.level.push_back(static_cast<std::uint16_t>(words.c0 % 256));
    }
  }
  return image;
}

void bench_match(const std::string& name, std::uint32_t paths, unsigned threads,
                 const std::string& instruction_set) {
  const auto match = [=](benchmark::State& state) {
    const GreyImage left = shifted_levels(kShift_px);
    const GreyImage right = shifted_levels(0);
    ThreadPool pool(threads);
    StereoMatcher matcher({.paths = paths});
    const StereoRun run = {.pool = &pool, .instruction_set = instruction_set};
    (void)matcher.match(left, right, run);  // takes the memory
    for (auto _ : state) benchmark::DoNotOptimize(matcher.match(left, right, run));
  };
  benchmark::RegisterBenchmark(name.c_str(), match)->Unit(benchmark::kMillisecond)->UseRealTime();
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::bench_match;
  for (const glidar::InstructionSet set : glidar::usable_instruction_sets()) {
    const std::string name = to_string(set);
    bench_match("8 paths, 1 thread, " + name, 8, 1, name);
    bench_match("4 paths, 1 thread, " + name, 4, 1, name);
  }
  bench_match("8 paths, 1 thread", 8, 1, "");
  bench_match("8 paths, 2 threads", 8, 2, "");
  return glidar::bench::run(
      argc, argv, {{"2 threads / 1 thread", "8 paths, 1 thread", "8 paths, 2 threads", 1.6}});
}

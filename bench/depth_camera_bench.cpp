// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Frames of depth cameras that are simulated from raw images, beside those by noise steps: a D435
// of 848x480 pixels and 128 disparities with the share of its matcher, a Kinect v1, a Kinect v2, an
// Azure Kinect and a structured-light scanner in a furnished room.
#include "ratio_reporter.hpp"
#include "room.hpp"

#include <glidar/depth_camera/stereo.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/simulate/simulator.hpp>

#include <string>

namespace glidar::bench {
namespace {

/// In a corner of the room; objects are 1.5 to 6 m away.
Pose camera_pose() {
  return look_at({-3.0, -3.0, 0.5}, {1.5, 0.5, -0.8}, Eigen::Vector3d::UnitZ());
}

/// Of a preset or a sensor file.
Sensor camera(const std::string& preset, DepthModel model) {
  Sensor sensor = load_sensor_file(find_sensor_file(preset));
  set_depth_model(model, preset, sensor);
  return sensor;
}

void bench_frames(const std::string& name, const std::string& preset, DepthModel model,
                  unsigned threads) {
  const auto simulate = [=](benchmark::State& state) {
    const Scene scene = make_room();
    Simulator simulator(scene, camera(preset, model), {.threads = threads});
    const Motion motion = static_motion(scene, camera_pose());
    Frame frame;
    simulator.simulate(motion, {}, frame);  // takes the memory
    for (auto _ : state) {
      ++frame.number;
      simulator.simulate(motion, {}, frame);
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), simulate)
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

/// The matcher alone, on the images of a frame.
void bench_matcher(const std::string& name, const std::string& preset, unsigned threads) {
  const auto match = [=](benchmark::State& state) {
    const Scene scene = make_room();
    const Sensor sensor = camera(preset, DepthModel::physical);
    const Frame frame = Simulator(scene, sensor).simulate(camera_pose());
    StereoMatcher matcher(std::get<ActiveStereo>(*sensor.depth_camera).matcher);
    ThreadPool pool(threads);
    const GreyImage& left = frame.raw_images[0].grey;
    const GreyImage& right = frame.raw_images[1].grey;
    (void)matcher.match(left, right, {.pool = &pool});  // takes the memory
    for (auto _ : state) benchmark::DoNotOptimize(matcher.match(left, right, {.pool = &pool}));
  };
  benchmark::RegisterBenchmark(name.c_str(), match)
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

void register_benchmarks() {
  const std::string scanner = GLIDAR_EXAMPLES "/scanner.yaml";
  for (const std::string& preset :
       {std::string("D435"), std::string("Kinect-v1"), std::string("Kinect-v2"),
        std::string("Azure-Kinect-NFOV"), scanner}) {
    const std::string name = preset == scanner ? "scanner" : preset;
    bench_frames(name + " law", preset, DepthModel::law, 2);
    bench_frames(name + " physical", preset, DepthModel::physical, 2);
  }
  bench_frames("D435 physical, 1 thread", "D435", DepthModel::physical, 1);
  bench_matcher("D435 matcher", "D435", 2);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  glidar::bench::register_benchmarks();
  return glidar::bench::run(
      argc, argv,
      {{"D435: frame / matcher", "D435 physical", "D435 matcher", 3.0},
       {"D435: 1 thread / 2 threads", "D435 physical, 1 thread", "D435 physical", 1.6}});
}

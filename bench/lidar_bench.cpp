// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Cost of a LiDAR's measurement and noise relative to casting the same beams: one rotation of a
// VLP-16 in a furnished room. And the cost of possible coincidences of a thousand objects with the
// ground under them.
#include "ratio_reporter.hpp"
#include "room.hpp"

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/sensor/lidar/footprint.hpp>
#include <glidar/simulate/simulator.hpp>

namespace glidar::bench {
namespace {

/// A ground of 200 m x 200 m 2 m below the sensor, and 1000 boxes of 1 m at this height over it.
Scene make_field(double height_m) {
  Scene scene;
  add_model(scene, make_builtin_model("plane"));
  scene.instances[0].scale = 100.0;
  scene.instances[0].world_from_object.translation().z() = -2.0;
  add_model(scene, make_builtin_model("box"));
  Instance box = scene.instances.back();
  scene.instances.pop_back();
  box.scale = 0.5;
  for (int i = 0; i < 1000; ++i) {
    const double x = 5.0 * (i % 40) - 97.5;
    const double y = 7.5 * (i / 40) - 90.0;  // NOLINT(bugprone-integer-division): a row
    box.world_from_object.translation() = Eigen::Vector3d(x, y, -1.5 + height_m);
    scene.instances.push_back(box);
  }
  return scene;
}

constexpr std::int64_t kPeriod_ns = 100'000'000;      ///< of a rotation
constexpr std::int64_t kDuration_ns = 9'900'000'000;  ///< of the motion

struct Stage {
  Scene scene = make_room();
  Sensor sensor = ground_truth_sensor(load_sensor_file(find_sensor_file("VLP-16")));
  Sensor noisy = sensor;
  Sensor wide = sensor;  ///< its beams are seven sub-rays
  Beams beams = make_beams(sensor);
  Motion motion = static_motion(scene, Pose::Identity());
  Motion moving = motion;

  Stage() {
    noisy.noise = {RangeGaussian{.sigma_m = 0.01}, Dropout{.probability = 0.01},
                   RangeQuantization{.step_m = 0.002}};
    wide.lidar_equation = LidarEquation{};
    wide.footprint = Footprint{.divergence_x_rad = 3e-3,
                               .divergence_y_rad = 1.5e-3,
                               .exit_x_m = 0.0095,
                               .exit_y_m = 0.0127,
                               .rings = 1};
    std::vector<TimedPose> poses;
    for (std::int64_t k = 0; k < 2000; ++k) {  // 200 poses a second
      poses.push_back(
          {.t_ns = k * 5'000'000, .position_m = {1e-4 * static_cast<double>(k), 0.0, 0.0}});
    }
    moving.world_from_sensor = TimedPoses(poses);
  }
};

void count_rays(const Stage& stage, benchmark::State& state) {
  state.counters["rays/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(stage.beams.size()),
      benchmark::Counter::kIsRate);
}

void cast(const Stage& stage, int times, Renderer& renderer, Hits& hits) {
  for (int k = 0; k < times; ++k) {
    renderer.cast({.beams = stage.beams,
                   .world_from_sensor = Pose::Identity(),
                   .world_from_instance = {},
                   .hit_columns = {.normal = true}},
                  hits);
  }
}

void register_cast(const Stage& stage, unsigned threads, int casts, const std::string& name) {
  benchmark::RegisterBenchmark(name.c_str(), [&stage, threads, casts](benchmark::State& state) {
    const auto renderer = make_renderer(stage.scene, {.threads = threads});
    Hits hits;
    for (auto _ : state) cast(stage, casts, *renderer, hits);
    count_rays(stage, state);
  })->UseRealTime();
}

/// Casts a footprint's beam samples with the columns that the lidar equation needs.
void register_sub_cast(const Stage& stage, unsigned threads, const FootprintLayout& footprints,
                       const std::string& name) {
  benchmark::RegisterBenchmark(name.c_str(), [&stage, threads,
                                              footprints](benchmark::State& state) {
    const auto renderer = make_renderer(stage.scene, {.threads = threads});
    Beams rays;
    expand_beams(sample_footprint(*stage.wide.footprint), stage.beams, {0, stage.beams.size()},
                 renderer->thread_pool(), rays);
    Hits hits;
    for (auto _ : state) {
      renderer->cast({.beams = rays,
                      .world_from_sensor = Pose::Identity(),
                      .world_from_instance = {},
                      .hit_columns = {.shading = true, .diffuse = true},
                      .footprints = footprints},
                     hits);
    }
    count_rays(stage, state);
  })->UseRealTime();
}

void register_simulation(const Stage& stage, const Sensor& sensor, const Motion& motion,
                         unsigned threads, const std::string& name) {
  benchmark::RegisterBenchmark(name.c_str(), [&, threads](benchmark::State& state) {
    const auto renderer = make_renderer(stage.scene, {.threads = threads});
    Simulator simulator(stage.scene, std::make_shared<const BeamCache>(sensor, stage.beams),
                        *renderer);
    Frame frame;
    for (auto _ : state) {
      frame.stamp_ns = (frame.stamp_ns + kPeriod_ns) % kDuration_ns;
      simulator.simulate(motion, {}, frame);
    }
    count_rays(stage, state);
  })->UseRealTime();
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  const glidar::bench::Stage stage;
  glidar::bench::Stage standing;
  glidar::bench::Stage hovering;
  standing.scene = glidar::bench::make_field(0.0);
  hovering.scene = glidar::bench::make_field(0.01);
  std::vector<glidar::bench::Ratio> ratios;
  for (const unsigned threads : {1U, 2U}) {
    const std::string at = std::to_string(threads) + " threads ";
    glidar::bench::register_cast(stage, threads, 1, at + "cast");
    glidar::bench::register_cast(stage, threads, 7, at + "seven casts");
    glidar::bench::register_sub_cast(stage, threads, {}, at + "sub-rays");
    glidar::bench::register_sub_cast(stage, threads, {7, 1.5e-3, 6.4e-3}, at + "sub-rays at once");
    glidar::bench::register_simulation(stage, stage.wide, stage.motion, threads, at + "footprint");
    glidar::bench::register_simulation(stage, stage.sensor, stage.motion, threads, at + "simulate");
    glidar::bench::register_simulation(stage, stage.noisy, stage.motion, threads,
                                       at + "with noise");
    glidar::bench::register_simulation(stage, stage.sensor, stage.moving, threads, at + "moving");
    glidar::bench::register_cast(standing, threads, 1, at + "1000 boxes on a ground");
    glidar::bench::register_cast(hovering, threads, 1, at + "1000 boxes over a ground");
    ratios.push_back({at + "boxes on a ground / over it", at + "1000 boxes over a ground",
                      at + "1000 boxes on a ground", 0.7});
    ratios.push_back({at + "simulate / cast", at + "cast", at + "simulate", 0.6});
    ratios.push_back({at + "moving along timed poses / cast", at + "cast", at + "moving", 0.6});
    ratios.push_back(
        {at + "moving along timed poses / simulate", at + "simulate", at + "moving", 0.6});
    ratios.push_back({at + "footprint of seven sub-rays / seven casts", at + "seven casts",
                      at + "footprint", 0.8});
    ratios.push_back({at + "sub-rays of a footprint at once / one by one", at + "sub-rays",
                      at + "sub-rays at once", 1.0});
    ratios.push_back({at + "footprint / cast of its sub-rays with the light's columns",
                      at + "sub-rays", at + "footprint", 0.8});
    ratios.push_back({at + "with noise / cast", at + "cast", at + "with noise", 0.6});
  }
  return glidar::bench::run(argc, argv, ratios);
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// A scene of 100,000 instances: time until it can be cast, and cost of moving one of them, or of
// one that is very far away. 50,000 boxes at one place, and as many behind a box.
#include "ratio_reporter.hpp"

#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <utility>
#include <vector>

namespace glidar::bench {
namespace {

constexpr int kSide = 316;

/// Boxes of 1 m on a grid of 3 m, of uneven heights.
Scene make_boxes() {
  Scene scene;
  add_model(scene, make_builtin_model("box"));
  Instance box = scene.instances[0];
  box.scale = 0.5;
  scene.instances.clear();
  for (int i = 0; i < kSide * kSide; ++i) {
    const int row = i / kSide;
    box.world_from_object.translation() =
        Eigen::Vector3d(3.0 * (i % kSide), 3.0 * row, 0.1 * (i % 7));
    scene.instances.push_back(box);
  }
  return scene;
}

/// The same and a box of 2e8 m, 1e11 m away and out of sight.
Scene make_boxes_and_far_one() {
  Scene scene = make_boxes();
  Instance box = scene.instances[0];
  box.scale = 1e8;
  box.world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 1e11);
  scene.instances.push_back(box);
  return scene;
}

/// A box, and others `behind` it in a row, or at its place.
Scene make_copies(bool behind) {
  constexpr int kCopies = 50'000;
  Scene scene;
  add_model(scene, make_builtin_model("box"));
  scene.instances[0].scale = 100.0;
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(300.0, 300.0, 0.0);
  Instance box = scene.instances[0];
  for (int i = 0; i < kCopies; ++i) {
    if (behind)
      box.world_from_object.translation() += Eigen::Vector3d(320.0, 330.0, -60.0).normalized();
    scene.instances.push_back(box);
  }
  return scene;
}

struct Stage {
  Scene scene;
  Beams beams = make_beams(pinhole_from_fov(512, 512, 1.0));
  Pose world_from_sensor = look_at({-20.0, -30.0, 60.0}, {300.0, 300.0, 0.0}, {0.0, 0.0, 1.0});
  std::vector<Pose> poses;

  explicit Stage(Scene what) : scene(std::move(what)) {
    for (const Instance& instance : scene.instances) poses.push_back(instance.world_from_object);
  }

  void cast(Renderer& renderer, Hits& hits) const {
    renderer.cast({.beams = beams,
                   .world_from_sensor = world_from_sensor,
                   .world_from_instance = poses,
                   .hit_columns = {.normal = true}},
                  hits);
  }
};

void register_first_cast(const Stage& stage, const std::string& name) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [&stage](benchmark::State& state) {
        for (auto _ : state) {
          Hits hits;
          stage.cast(*make_renderer(stage.scene, {.kind = "rays", .threads = 2}), hits);
        }
      })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

/// Moves so many instances; `step` counts moves.
void move_some(std::size_t count, std::size_t& step, std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < count; ++i) {
    Pose& pose = poses[(997 * ++step) % poses.size()];
    pose.translation().z() = 0.01 * static_cast<double>(step % 50);
  }
}

/// `moved`: how many instances move before each cast.
void register_casts(Stage& stage, std::size_t moved, const std::string& name) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [&stage, moved](benchmark::State& state) {
                                 const auto renderer =
                                     make_renderer(stage.scene, {.kind = "rays", .threads = 2});
                                 Hits hits;
                                 stage.cast(*renderer, hits);
                                 std::size_t step = 0;
                                 for (auto _ : state) {
                                   move_some(moved, step, stage.poses);
                                   stage.cast(*renderer, hits);
                                 }
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  glidar::bench::Stage stage(glidar::bench::make_boxes());
  glidar::bench::Stage with_far_one(glidar::bench::make_boxes_and_far_one());
  glidar::bench::Stage hidden(glidar::bench::make_copies(true));
  glidar::bench::Stage coincident(glidar::bench::make_copies(false));
  glidar::bench::register_first_cast(stage, "first cast");
  glidar::bench::register_casts(hidden, 0, "50,000 hidden");
  glidar::bench::register_casts(coincident, 0, "50,000 coincident");
  glidar::bench::register_casts(stage, 0, "at rest");
  glidar::bench::register_casts(stage, 1, "one moves");
  glidar::bench::register_casts(stage, 1000, "1000 move");
  glidar::bench::register_casts(with_far_one, 0, "one is at 1e11 m");
  return glidar::bench::run(
      argc, argv,
      {{"one is at 1e11 m / none is", "at rest", "one is at 1e11 m", 0.8},
       {"one of 100,000 moves / none does", "at rest", "one moves", 0.99},
       {"1000 move / none does", "at rest", "1000 move", 0.0},
       {"50,000 coincident / 50,000 hidden", "50,000 hidden", "50,000 coincident", 0.99}});
}

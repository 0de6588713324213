// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Images of cameras with distorting lenses: raster, rays and auto, on one thread, in processor
// time, with range, normal and triangle of every hit.
#include "ratio_reporter.hpp"

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/render/renderer.hpp>

#include <Eigen/Geometry>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

namespace glidar::bench {
namespace {

struct Stage {
  std::string name;
  Scene scene;
  Pose pose;
};

std::unique_ptr<Stage> make_stage(const std::string& name, const Model& model,
                                  const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  auto stage = std::make_unique<Stage>();
  stage->name = name;
  add_model(stage->scene, model);
  stage->pose = look_at(eye, target, Eigen::Vector3d::UnitZ());
  std::printf("%s: %zu triangles\n", name.c_str(), stage->scene.meshes[0].triangles.size());
  return stage;
}

/// A model seen from a distance.
std::unique_ptr<Stage> make_view(const std::string& name, const std::string& file,
                                 double distance_m) {
  const Model model = load_model(file, {}, {});
  const Eigen::Vector3d centre = bounds(model.mesh).center();
  const Eigen::Vector3d outward = Eigen::Vector3d(0.02, 0.05, 1.0).normalized();
  return make_stage(name, model, centre + distance_m * outward, centre);
}

std::vector<std::unique_ptr<Stage>> make_stages() {
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(
      make_stage("cave", make_builtin_model("asteroid"), {0.13, 0.04, 0.02}, {1.0, 0.2, 0.1}));
  const char* folder = std::getenv("GLIDAR_DATA");
  if (folder == nullptr) {
    std::puts("GLIDAR_DATA is not set: without the apartment, the bunny and the dragon");
    return stages;
  }
  const std::string data = folder;
  const Model apartment =
      load_model(data + "/scenes/gazebo/apartment/meshes/apartment.dae", {}, {});
  const Eigen::Vector3d centre = bounds(apartment.mesh).center();
  const Eigen::Vector3d eye(centre.x() + 0.1, centre.y() + 0.07, 1.5);
  stages.push_back(make_stage("apartment", apartment, eye, eye + Eigen::Vector3d(1.0, 0.3, -0.1)));
  stages.push_back(make_view("bunny", data + "/models/stanford/bun_zipper.ply", 0.22));
  stages.push_back(
      make_view("dragon", data + "/models/stanford/dragon/dragon_vrip_binary.ply", 0.25));
  return stages;
}

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void add_renderer(const Stage& stage, const std::shared_ptr<Beams>& beams, const std::string& kind,
                  const std::string& name) {
  const auto hits = std::make_shared<Hits>();
  const auto renderer = std::shared_ptr(make_renderer(stage.scene, {.kind = kind, .threads = 1}));
  const auto cast = [&stage, beams, hits, renderer] {
    renderer->cast(
        {.beams = *beams, .world_from_sensor = stage.pose, .hit_columns = {.normal = true}}, *hits);
  };
  benchmark::RegisterBenchmark(name.c_str(), [cast](benchmark::State& state) {
    cast();  // trees and tables are built, memory is touched
    for (auto _ : state) {
      const double begin = process_seconds();
      cast();
      state.SetIterationTime(process_seconds() - begin);
    }
  })->UseManualTime();
}

void add_camera(const Stage& stage, const std::string& sensor, std::vector<Ratio>& ratios) {
  const auto beams =
      std::make_shared<Beams>(make_beams(load_sensor_file(find_sensor_file(sensor))));
  const std::string at = stage.name + " " + sensor + " ";
  for (const char* kind : {"rays", "raster", "auto"}) add_renderer(stage, beams, kind, at + kind);
  ratios.push_back({at + "raster / rays", at + "rays", at + "raster", 0.0});
  ratios.push_back({at + "auto / rays", at + "rays", at + "auto", 0.0});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  const auto stages = glidar::bench::make_stages();
  std::vector<glidar::bench::Ratio> ratios;
  for (const auto& stage : stages) {
    for (const char* sensor : {"Azure-Kinect-NFOV", "Azure-Kinect-NFOV-2x2", "Azure-Kinect-WFOV",
                               "Azure-Kinect-WFOV-2x2", "Kinect-v2"}) {
      glidar::bench::add_camera(*stage, sensor, ratios);
    }
  }
  return glidar::bench::run(argc, argv, ratios);
}

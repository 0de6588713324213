// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Point clouds (x, y, z, intensity) per second, compared with the original GLIDAR's method.
#include "many_views.hpp"
#include "ratio_reporter.hpp"
#include "woods2016_pipeline.hpp"

#include <glidar/core/point_cloud.hpp>
#include <glidar/simulate/simulator.hpp>
#include <glidar/woods2016/framebuffer.hpp>

#include <array>
#include <string>

namespace glidar::bench {
namespace {

Sensor camera(std::uint32_t side) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(side, side, kFov_rad);
  return sensor;
}

/// GLIDAR, from a pose to a compact cloud.
class Clouds {
 public:
  Clouds(const Model* model, const char* kind, bool is_quantized, std::uint32_t side)
      : model_(*model),
        simulator_(model->scene, camera(side), options(kind)),
        motion_(static_motion(model->scene, model->world_from_sensor)) {
    if (!is_quantized) return;
    camera_ = make_woods2016_camera(model->scene, options("opengl"));
    simulator_.set_return_replacement(woods2016_measurement(*camera_));
  }

  void measure() {
    simulator_.simulate(motion_, {}, frame_);
    make_point_cloud(frame_, *simulator_.beams(), model_.scene,
                     {.frame_id = "camera", .thread_pool = &simulator_.renderer().thread_pool()},
                     kColumns, organised_);
    remove_invalid_points(organised_, cloud_);
  }

 private:
  inline static const std::array<std::string, 2> kColumns = {"xyz", "intensity"};
  const Model& model_;
  Simulator simulator_;
  Motion motion_;
  std::unique_ptr<Woods2016Camera> camera_;
  Frame frame_;
  PointCloud organised_;
  PointCloud cloud_;
};

template <class Way, class... Arguments>
void add(const std::string& name, Arguments... arguments) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [arguments...](benchmark::State& state) {
                                 Way way(arguments...);
                                 for (auto _ : state) way.measure();
                               })
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

void register_model(const Model* model, std::uint32_t side, double goal,
                    std::vector<Ratio>& ratios) {
  struct Ours {
    std::string name;
    const char* kind;
    bool is_quantized;
  };
  const std::string at = model->name + " " + std::to_string(side) + " ";
  add<Woods2016Pipeline>(at + "Woods 2016", model, side);
  for (const Ours& ours : {Ours{"rays", "rays", false}, Ours{"gpu", "gpu", false},
                           Ours{"opengl, quantized framebuffer", "rays", true}}) {
    add<Clouds>(at + ours.name, model, ours.kind, ours.is_quantized, side);
    ratios.push_back({at + ours.name + " / Woods 2016", at + "Woods 2016", at + ours.name, goal});
  }
}

int run_all(int argc, char** argv) {
  const std::vector<std::unique_ptr<Model>> all = models();
  std::vector<Ratio> ratios;
  for (const auto& model : all) {
    register_model(model.get(), 256, 1.0, ratios);
    register_model(model.get(), 512, 1.0, ratios);
    register_model(model.get(), 1024, 1.5, ratios);
  }
  return run(argc, argv, ratios);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  return glidar::bench::run_all(argc, argv);
}

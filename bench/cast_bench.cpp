// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Speed of casts and complete simulations relative to raw Embree. The reference is the best packet
// layout: 16 rays over 4x4 pixels, coherent, robust; range, normal and ids are stored.
#include "embree_api.hpp"
#include "ratio_reporter.hpp"

#include <glidar/io/model/model.hpp>
#include <glidar/simulate/simulator.hpp>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace glidar::bench {
namespace {

constexpr std::uint32_t kSide = 512;
constexpr double kFov = 0.35;

/// A model that fills the view of a square camera.
struct Stage {
  std::string name;
  Scene scene;
  Sensor sensor;
  Beams beams;
  Pose world_from_sensor;

  Stage(std::string stage_name, const std::string& model) : name(std::move(stage_name)) {
    add_model(scene, load_model(model, {}, {}));
    sensor.optics = pinhole_from_fov(kSide, kSide, kFov);
    beams = make_beams(sensor);
    const Eigen::AlignedBox3d box = bounds(scene);
    const double distance = 0.55 * box.sizes().maxCoeff() / std::tan(kFov / 2.0);
    world_from_sensor = look_at(box.center() + distance * Eigen::Vector3d::UnitZ(), box.center(),
                                Eigen::Vector3d::UnitY());
  }
};

/// The baseline: Embree alone.
class RawEmbree {
 public:
  RawEmbree(const Stage& stage, int threads)
      : stage_(stage),
        arena_(threads),
        device_(rtcNewDevice(nullptr)),
        scene_(make_embree_scene(device_, stage.scene.meshes[0])) {
    range_.resize(std::size_t{kSide} * kSide);
    normal_.resize(range_.size());
    instance_.resize(range_.size());
    primitive_.resize(range_.size());
  }
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;
  ~RawEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void cast() {
    arena_.execute([this] {
      tbb::parallel_for(0U, kSide / 4 * kSide / 4, [this](unsigned tile) { cast_tile(tile); });
    });
  }

 private:
  void cast_tile(unsigned tile) {
    const unsigned first_row = tile / (kSide / 4) * 4;
    const unsigned first_col = tile % (kSide / 4) * 4;
    const auto focal = static_cast<float>(0.5 * kSide / std::tan(kFov / 2.0));
    const Eigen::Matrix3f rotation = stage_.world_from_sensor.linear().cast<float>();
    const Eigen::Vector3f origin =
        (stage_.world_from_sensor.translation() - stage_.scene.meshes[0].origin_m).cast<float>();
    alignas(64) RTCRayHit16 packet;
    alignas(64) int valid[16];
    for (unsigned lane = 0; lane < 16; ++lane) {
      const float x = static_cast<float>(first_col + lane % 4) + 0.5F - 0.5F * kSide;
      const unsigned row = first_row + lane / 4;
      const float y = static_cast<float>(row) + 0.5F - 0.5F * kSide;
      const Eigen::Vector3f direction =
          rotation * Eigen::Vector3f(x / focal, y / focal, 1.0F).normalized();
      valid[lane] = -1;
      packet.ray.org_x[lane] = origin.x();
      packet.ray.org_y[lane] = origin.y();
      packet.ray.org_z[lane] = origin.z();
      packet.ray.dir_x[lane] = direction.x();
      packet.ray.dir_y[lane] = direction.y();
      packet.ray.dir_z[lane] = direction.z();
      packet.ray.tnear[lane] = 0.0F;
      packet.ray.tfar[lane] = 1e30F;
      packet.ray.time[lane] = 0.0F;
      packet.ray.mask[lane] = ~0U;
      packet.ray.id[lane] = lane;
      packet.ray.flags[lane] = 0;
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    intersect_packet(scene_, valid, packet);
    for (unsigned lane = 0; lane < 16; ++lane) {
      const std::size_t i = std::size_t{first_row + lane / 4} * kSide + first_col + lane % 4;
      range_[i] = packet.ray.tfar[lane];
      normal_[i] =
          Eigen::Vector3f(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane])
              .normalized();
      instance_[i] = packet.hit.geomID[lane];
      primitive_[i] = packet.hit.primID[lane];
    }
  }

  const Stage& stage_;
  tbb::task_arena arena_;
  RTCDevice device_;
  RTCScene scene_;
  std::vector<float> range_;
  std::vector<Eigen::Vector3f> normal_;
  std::vector<unsigned> instance_;
  std::vector<unsigned> primitive_;
};

void count_rays(benchmark::State& state) {
  state.counters["rays/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * kSide * kSide, benchmark::Counter::kIsRate);
}

/// A renderer's casts, and measurements with its hits, beside raw Embree.
void register_renderer(const Stage& stage, const std::string& kind, unsigned threads,
                       const std::string& at, std::vector<Ratio>& ratios) {
  const std::string name = at + kind + " ";
  benchmark::RegisterBenchmark((name + "cast").c_str(), [&stage, kind,
                                                         threads](benchmark::State& state) {
    const auto renderer = make_renderer(stage.scene, {.kind = kind, .threads = threads});
    const CastRequest request{.beams = stage.beams,
                              .world_from_sensor = stage.world_from_sensor,
                              .hit_columns = {.normal = true}};
    Hits hits;
    renderer->cast(request, hits);  // builds trees and allocates memory
    for (auto _ : state) renderer->cast(request, hits);
    count_rays(state);
  })->UseRealTime();
  benchmark::RegisterBenchmark((name + "simulate").c_str(), [&stage, kind,
                                                             threads](benchmark::State& state) {
    const auto renderer = make_renderer(stage.scene, {.kind = kind, .threads = threads});
    const Motion motion = static_motion(stage.scene, stage.world_from_sensor);
    Simulator simulator(stage.scene, stage.sensor, *renderer);
    Frame frame;
    simulator.simulate(motion, {}, frame);  // builds trees and allocates memory
    for (auto _ : state) simulator.simulate(motion, {}, frame);
    count_rays(state);
  })->UseRealTime();
  const bool casts_rays = kind == "rays";  // only it has goals
  ratios.push_back(
      {name + "cast / raw Embree", at + "raw", name + "cast", casts_rays ? 0.85 : 0.0});
  ratios.push_back(
      {name + "simulate / raw Embree", at + "raw", name + "simulate", casts_rays ? 0.7 : 0.0});
}

void register_stage(const Stage& stage, unsigned threads, std::vector<Ratio>& ratios) {
  const std::string at = stage.name + " " + std::to_string(threads) + " threads ";
  benchmark::RegisterBenchmark((at + "raw").c_str(), [&stage, threads](benchmark::State& state) {
    RawEmbree raw(stage, static_cast<int>(threads));
    for (auto _ : state) raw.cast();
    count_rays(state);
  })->UseRealTime();
  for (const char* kind : {"rays", "raster"}) {
    register_renderer(stage, kind, threads, at, ratios);
  }
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::Ratio;
  using glidar::bench::Stage;
  const char* data = std::getenv("GLIDAR_DATA");
  std::vector<std::unique_ptr<Stage>> stages;
  if (data != nullptr) {
    const std::string stanford = std::string(data) + "/models/stanford/";
    stages.push_back(std::make_unique<Stage>("bunny", stanford + "bun_zipper.ply"));
    stages.push_back(std::make_unique<Stage>("dragon", stanford + "dragon/dragon_vrip_binary.ply"));
  } else {
    std::puts("GLIDAR_DATA is not set: the built-in asteroid replaces the Stanford models");
    stages.push_back(std::make_unique<Stage>("asteroid", "builtin:asteroid"));
  }
  std::vector<Ratio> ratios;
  for (const auto& stage : stages) {
    for (const unsigned threads : {1U, 2U}) register_stage(*stage, threads, ratios);
    for (const char* work : {"rays cast", "rays simulate", "raster cast", "raster simulate"}) {
      ratios.push_back({stage->name + " two threads / one, " + work,
                        stage->name + " 1 threads " + work, stage->name + " 2 threads " + work,
                        1.7});
    }
  }
  return glidar::bench::run(argc, argv, ratios);
}

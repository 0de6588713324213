// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Which way the beams of a LiDAR with a footprint take, in several scenes. Prints shares.
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/render/rays/footprint_search.hpp>
#include <glidar/render/rays/rays_renderer.hpp>
#include <glidar/render/rays/tile_cast.hpp>
#include <glidar/simulate/simulator.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace glidar::bench {
namespace {

using rays::FootprintWay;

/// Casts rays, and counts how footprints are found and measured.
class CountingRenderer final : public Renderer {
 public:
  explicit CountingRenderer(const Scene& scene)
      : base_(std::make_shared<CpuBase>(scene, 1)),
        tiles_(*base_),
        renderer_(make_rays_renderer(base_)) {}

  [[nodiscard]] std::string_view name() const override { return renderer_->name(); }
  [[nodiscard]] ThreadPool& thread_pool() override { return base_->thread_pool; }

  void cast(const CastRequest& request, Hits& hits) override {
    const std::size_t size = request.footprints.beams;
    std::vector<FootprintWay> ways(request.beams.size() / size);
    std::vector<OtherHits> needed(ways.size(), OtherHits::all_columns);
    if (tiles_.prepare(request, hits)) {
      rays::FootprintSearch(base_->search.beams()).find({0, ways.size()}, hits, ways);
    }
    const auto ask = [&](BeamRange run, std::span<OtherHits> of_run) {
      request.needed_of_others(run, of_run);
      std::copy(of_run.begin(), of_run.end(),
                needed.begin() + static_cast<std::ptrdiff_t>(run.begin / size));
    };
    CastRequest asked = request;
    asked.needed_of_others = FunctionRef<void(BeamRange, std::span<OtherHits>)>(ask);
    renderer_->cast(asked, hits);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const bool hits_one_plane =
          needed[i] != OtherHits::all_columns && hits.instance[i * size] != kInvalidId;
      ++count_[static_cast<std::size_t>(ways[i])][hits_one_plane ? 1 : 0];
    }
  }

  void print(const char* scene) const {
    double sum = 0.0;
    for (const auto& of_way : count_) sum += static_cast<double>(of_way[0] + of_way[1]);
    const auto share = [&](FootprintWay way, std::size_t is_integrated) {
      return 100.0 * static_cast<double>(count_[static_cast<std::size_t>(way)][is_integrated]) /
             sum;
    };
    std::printf("%-16s %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f\n", scene,
                share(FootprintWay::nothing, 0), share(FootprintWay::one_triangle, 1),
                share(FootprintWay::one_triangle, 0), share(FootprintWay::candidates, 1),
                share(FootprintWay::candidates, 0), share(FootprintWay::single, 1),
                share(FootprintWay::single, 0));
  }

 private:
  std::shared_ptr<CpuBase> base_;
  rays::TileCast tiles_;
  std::unique_ptr<Renderer> renderer_;
  std::array<std::array<std::size_t, 2>, 4> count_{};  ///< per way: others, integrated
};

void count(const char* name, const Scene& scene, const Eigen::Vector3d& place_m) {
  const Sensor sensor = load_sensor_file(find_sensor_file("OS1-128"));
  CountingRenderer renderer(scene);
  Simulator simulator(scene, sensor, renderer);
  Pose pose = Pose::Identity();
  pose.translation() = place_m;
  Frame frame;
  simulator.simulate(static_motion(scene, pose), {}, frame);
  renderer.print(name);
}

/// A model whose longest side has this length.
Scene scaled(Model model, double length_m) {
  Scene scene;
  add_model(scene, std::move(model));
  const double scale = length_m / bounds(scene).sizes().maxCoeff();
  for (Instance& instance : scene.instances) instance.scale *= scale;
  return scene;
}

void count_all(const std::string& data) {
  std::printf("%-16s %8s %17s %17s %17s\n%-16s %8s %8s %8s %8s %8s %8s %8s\n", "OS1-128, %", "",
              "one triangle", "candidates", "traced singly", "", "nothing", "closed", "other",
              "closed", "other", "closed", "other");
  Scene apartment;
  add_model(apartment, load_model(data + "/scenes/gazebo/apartment/meshes/apartment.dae", {}, {}));
  count("apartment", apartment, {0.0, 0.0, 1.5});
  const std::string street = std::string(GLIDAR_EXAMPLES) + "/street.yaml";
  count("street", load_scene_file(street, {}, {}).scene, {0.0, 0.0, 1.5});
  const Scene cave = scaled(make_builtin_model("asteroid"), 20.0);
  count("cave", cave, bounds(cave).center());  // the asteroid from inside
  const Scene rock = scaled(load_model(data + "/models/rocks/glidar_test11.obj", {}, {}), 4.0);
  count("rock", rock, bounds(rock).center() - Eigen::Vector3d(4.0, 0.0, 0.0));
  const std::string dragon_file = data + "/models/stanford/dragon/dragon_vrip_binary.ply";
  const Scene dragon = scaled(load_model(dragon_file, {}, {}), 2.0);
  const Eigen::Vector3d middle = bounds(dragon).center();
  count("dragon at 5 m", dragon, middle - Eigen::Vector3d(0.0, 5.0, 0.0));
  count("dragon at 1.5 m", dragon, middle - Eigen::Vector3d(0.0, 1.5, 0.0));
}

}  // namespace
}  // namespace glidar::bench

int main() {
  const char* data = std::getenv("GLIDAR_DATA");
  if (data == nullptr) {
    std::fputs("footprint_bench: set GLIDAR_DATA\n", stderr);
    return 2;
  }
  try {
    glidar::bench::count_all(data);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "footprint_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}

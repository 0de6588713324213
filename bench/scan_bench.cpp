// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// A rotation of spinning scanners indoors and outdoors: raster, rays and raw Embree, on one thread,
// in processor time, with range, normal and triangle of every hit.
#include "ratio_reporter.hpp"
#include "raw_rays.hpp"

#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/renderer.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <numbers>

namespace glidar::bench {
namespace {

struct Pattern {
  std::string name;
  std::uint32_t rows;
  std::uint32_t cols;
  double low_deg;
  double high_deg;
  double spread_deg;  ///< between the middle and each of six rays around it; 0: single rays
  double exit_m;      ///< from the origin of the middle ray to those of the six
  double raw_goal;    ///< raster / raw Embree in the scenes with few, some and many triangles
  double some_goal;
  double many_goal;
};

/// Beam samples of one beam.
std::uint32_t rays_per_beam(const Pattern& pattern) {
  return pattern.spread_deg > 0.0 ? 7 : 1;
}

/// Each beam sample has a separate row.
Beams make_beams(const Pattern& pattern) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const std::uint32_t rays = rays_per_beam(pattern);
  Beams beams;
  beams.rows = pattern.rows * rays;
  beams.cols = pattern.cols;
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  for (std::uint32_t row = 0; row < beams.rows; ++row) {
    const std::uint32_t beam_row = row / rays;
    const double part = static_cast<double>(beam_row) / (pattern.rows - 1);
    const double turn = std::numbers::pi / 3.0 * (row % rays);
    const double spread = row % rays == 0 ? 0.0 : kDegree * pattern.spread_deg;
    const double up = kDegree * (pattern.high_deg + part * (pattern.low_deg - pattern.high_deg)) +
                      spread * std::sin(turn);
    for (std::uint32_t col = 0; col < pattern.cols; ++col) {
      const double azimuth =
          2.0 * std::numbers::pi * col / pattern.cols + spread * std::cos(turn) / std::cos(up);
      const Eigen::Vector3d d(std::cos(azimuth) * std::cos(up), std::sin(azimuth) * std::cos(up),
                              std::sin(up));
      beams.directions.push_back(d.normalized());
      if (pattern.exit_m == 0.0) continue;
      const double exit_m = row % rays == 0 ? 0.0 : pattern.exit_m;
      const Eigen::Vector3d across(-std::sin(azimuth), std::cos(azimuth), 0.0);
      beams.origins_m.push_back(
          exit_m * (std::sin(turn) * across - std::cos(turn) * d.normalized().cross(across)));
    }
  }
  return beams;
}

/// Beam after beam.
RayList packets_of_rays(const Beams& beams, std::uint32_t rays, const Eigen::Vector3d& origin) {
  RayList list{true, {}};
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t beam = i / rays;
    const std::size_t row = beam / beams.cols * rays + i % rays;
    const std::size_t at = row * beams.cols + beam % beams.cols;
    const Eigen::Vector3d offset =
        beams.origins_m.empty() ? Eigen::Vector3d::Zero() : beams.origins_m[at];
    list.rays.push_back({origin + offset, beams.directions[at]});
  }
  return list;
}

/// Beams in packets of 4 x 4, which Embree traces fastest.
RayList packets_of(const Beams& beams, const Eigen::Vector3d& origin) {
  RayList list{true, {}};
  for (std::uint32_t tile = 0; tile < beams.size() / 16; ++tile) {
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::uint32_t col = tile % (beams.cols / 4) * 4 + i % 4;
      const std::uint32_t row = tile / (beams.cols / 4) * 4 + i / 4;
      list.rays.push_back({origin, beams.directions[std::size_t{row} * beams.cols + col]});
    }
  }
  return list;
}

void append(Mesh& mesh, const Mesh& part, const Eigen::Vector3f& at, float scale) {
  const auto base = static_cast<std::uint32_t>(mesh.positions_m.size());
  for (const Eigen::Vector3f& p : part.positions_m) mesh.positions_m.push_back(scale * p + at);
  for (const Triangle& t : part.triangles) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

/// An uneven ground, one cell per two triangles.
Mesh make_ground(std::uint32_t cells, float size_m) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= cells; ++y) {
    for (std::uint32_t x = 0; x <= cells; ++x) {
      const float u = size_m * (static_cast<float>(x) / static_cast<float>(cells) - 0.5F);
      const float v = size_m * (static_cast<float>(y) / static_cast<float>(cells) - 0.5F);
      mesh.positions_m.emplace_back(u, v, -1.8F + 0.12F * std::sin(1.3F * u) * std::cos(0.9F * v));
    }
  }
  for (std::uint32_t y = 0; y < cells; ++y) {
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x;
      mesh.triangles.push_back({a, a + 1, a + cells + 2});
      mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
    }
  }
  return mesh;
}

struct Stage {
  std::string name;
  Scene scene;
  Eigen::Vector3d sensor_m;
  int size;  ///< 0, 1, 2: few, some, many triangles

  [[nodiscard]] Pose pose() const {
    Pose pose = Pose::Identity();
    pose.translation() = sensor_m;
    return pose;
  }
};

Scene scene_with(Mesh mesh) {
  Scene scene;
  add_model(scene, make_builtin_model("box"));
  scene.meshes[0] = std::move(mesh);
  return scene;
}

/// The inside of a rock.
std::unique_ptr<Stage> make_cave() {
  Mesh mesh;
  append(mesh, make_builtin_model("asteroid").mesh, Eigen::Vector3f::Zero(), 10.0F);
  return std::make_unique<Stage>(Stage{"cave", scene_with(std::move(mesh)), {1.3, 0.4, 0.2}, 1});
}

/// Seven rocks around the sensor on a ground.
std::unique_ptr<Stage> make_rocks() {
  Mesh mesh = make_ground(512, 80.0F);
  const Mesh rock = make_builtin_model("asteroid").mesh;
  for (int i = 0; i < 7; ++i) {
    const float angle = 0.9F * static_cast<float>(i);
    const float radius = 6.0F + 2.5F * static_cast<float>(i % 3);
    append(mesh, rock, {radius * std::cos(angle), radius * std::sin(angle), -0.9F}, 1.8F);
  }
  return std::make_unique<Stage>(Stage{"rocks", scene_with(std::move(mesh)), {0.5, 0.3, 0.0}, 2});
}

std::unique_ptr<Stage> make_apartment(const std::string& data) {
  const Mesh model =
      load_model(data + "/scenes/gazebo/apartment/meshes/apartment.dae", {}, {}).mesh;
  const Eigen::AlignedBox3d box = bounds(model);
  Mesh mesh;
  append(mesh, model, Eigen::Vector3f::Zero(), 1.0F);
  mesh.origin_m = model.origin_m;
  const Eigen::Vector3d eye(box.center().x() + 0.1, box.center().y() + 0.07, 1.5);
  return std::make_unique<Stage>(Stage{"apartment", scene_with(std::move(mesh)), eye, 0});
}

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Cast>
void add(const std::string& name, std::size_t beams, const Cast& cast) {
  benchmark::RegisterBenchmark(name.c_str(), [cast, beams](benchmark::State& state) {
    cast();  // trees and tables are built, memory is touched
    for (auto _ : state) {
      const double begin = process_seconds();
      cast();
      state.SetIterationTime(process_seconds() - begin);
    }
    state.counters["rays/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(beams),
                           benchmark::Counter::kIsRate);
  })->UseManualTime();
}

void add_renderer(const Stage& stage, const std::shared_ptr<Beams>& beams, const std::string& kind,
                  const std::string& name) {
  const auto hits = std::make_shared<Hits>();
  const auto renderer = std::shared_ptr(make_renderer(stage.scene, {.kind = kind, .threads = 1}));
  add(name, beams->size(), [&stage, beams, hits, renderer] {
    renderer->cast(
        {.beams = *beams, .world_from_sensor = stage.pose(), .hit_columns = {.normal = true}},
        *hits);
  });
}

void add_pattern(const Stage& stage, const Pattern& pattern, std::vector<Ratio>& ratios) {
  const std::string at = stage.name + " " + pattern.name + " ";
  const auto beams = std::make_shared<Beams>(make_beams(pattern));
  const Mesh& mesh = stage.scene.meshes[0];
  const std::uint32_t rays = rays_per_beam(pattern);
  const Eigen::Vector3d from = stage.sensor_m - mesh.origin_m;
  const auto list = std::make_shared<RayList>(rays > 1 ? packets_of_rays(*beams, rays, from)
                                                       : packets_of(*beams, from));
  const auto raw = std::make_shared<RawRays>(mesh, *list, 16, "");
  add(at + "raw", beams->size(), [list, raw] { raw->cast(); });
  for (const char* kind : {"rays", "raster", "auto"}) {
    add_renderer(stage, beams, kind, at + kind);
    const double goals[] = {pattern.raw_goal, pattern.some_goal, pattern.many_goal};
    const bool is_raster = kind == std::string("raster");
    ratios.push_back(
        {at + kind + " / raw Embree", at + "raw", at + kind, is_raster ? goals[stage.size] : 0.0});
  }
  ratios.push_back({at + "raster / rays", at + "rays", at + "raster", 0.0});
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  using glidar::bench::Pattern;
  using glidar::bench::Stage;
  std::vector<std::unique_ptr<Stage>> stages;
  if (const char* data = std::getenv("GLIDAR_DATA"); data != nullptr) {
    stages.push_back(glidar::bench::make_apartment(data));
  } else {
    std::puts("GLIDAR_DATA is not set: without the apartment");
  }
  stages.push_back(glidar::bench::make_cave());
  stages.push_back(glidar::bench::make_rocks());
  const std::vector<Pattern> patterns = {
      {"64x2048", 64, 2048, -24.8, 2.0, 0.0, 0.0, 4.0, 2.5, 1.1},
      {"16x1800", 16, 1800, -15.0, 15.0, 0.0, 0.0, 3.0, 1.8, 1.1},
      {"64x2048x7", 64, 2048, -24.8, 2.0, 0.06, 0.0, 3.5, 2.5, 1.4},
      {"64x2048x7_exit", 64, 2048, -24.8, 2.0, 0.06, 0.005, 0.0, 0.0, 0.0}};
  std::vector<glidar::bench::Ratio> ratios;
  for (const auto& stage : stages) {
    std::printf("%s: %zu triangles\n", stage->name.c_str(),
                stage->scene.meshes[0].triangles.size());
    for (const Pattern& pattern : patterns) glidar::bench::add_pattern(*stage, pattern, ratios);
  }
  return glidar::bench::run(argc, argv, ratios);
}

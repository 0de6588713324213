// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Speed of a cast relative to plain OpenGL, and the gain of batches for many small frames. The
// reference (raw_opengl.hpp) draws the same triangles into the same targets (a 32-bit number and a
// float depth per pixel) and reads the numbers back.
#include "many_views.hpp"
#include "ratio_reporter.hpp"

#include <glidar/sensor/sensor.hpp>
#include <glidar/woods2016/framebuffer.hpp>

#include <memory>

namespace glidar::bench {
namespace {

template <class Body>
void add(const std::string& name, const Body& body) {
  benchmark::RegisterBenchmark(name.c_str(), body)->MeasureProcessCPUTime()->UseRealTime();
}

void register_raw(const std::string& name, const Model& model, const Raw& raw, std::uint32_t side) {
  add(name, [&model, &raw, side](benchmark::State& state) {
    RawOpengl baseline(model, raw, side);
    for (auto _ : state) baseline.draw_and_read();
  });
}

void register_cast(const std::string& name, const Model& model, const char* kind,
                   std::uint32_t side) {
  add(name, [&model, side, kind](benchmark::State& state) {
    const auto renderer = make_renderer(model.scene, options(kind));
    const Beams beams = make_beams(pinhole_from_fov(side, side, kFov_rad));
    Hits hits;
    for (auto _ : state) {
      renderer->cast({.beams = beams,
                      .world_from_sensor = model.world_from_sensor,
                      .hit_columns = {.normal = true}},
                     hits);
    }
  });
}

/// Draws the framebuffer and decodes it.
void register_framebuffer(const std::string& name, const Model& model, std::uint32_t side) {
  add(name, [&model, side](benchmark::State& state) {
    const auto camera = make_woods2016_camera(model.scene, options("opengl"));
    const Beams beams = make_beams(pinhole_from_fov(side, side, kFov_rad));
    ThreadPool thread_pool(kThreads);
    Woods2016Framebuffer picture;
    std::vector<double> range_m(beams.size());
    std::vector<float> intensity(beams.size());
    const auto read = [&](std::size_t begin, std::size_t end) {
      decode_framebuffer(picture, beams, {begin, end}, range_m, intensity);
    };
    for (auto _ : state) {
      camera->draw({.beams = beams, .world_from_sensor = model.world_from_sensor}, {}, {}, picture);
      thread_pool.parallel_for(beams.size(), 4096, read);
    }
  });
}

void register_model(const Model& model, std::uint32_t side, std::vector<Ratio>& ratios) {
  constexpr double kGoal = 0.85;
  const std::string at = model.name + " " + std::to_string(side) + " ";
  register_raw(at + "raw numbers", model, kRawNumbers, side);
  register_cast(at + "gpu", model, "gpu", side);
  register_cast(at + "rays", model, "rays", side);
  register_raw(at + "raw framebuffer", model, kRawFramebuffer, side);
  register_framebuffer(at + "framebuffer", model, side);
  ratios.push_back({at + "cast / raw OpenGL", at + "raw numbers", at + "gpu", 0.0});
  ratios.push_back({at + "quantized framebuffer / raw OpenGL", at + "raw framebuffer",
                    at + "framebuffer", kGoal});
  ratios.push_back({at + "gpu / rays", at + "rays", at + "gpu", 0.0});
}

void register_batches(const Model& model, std::uint32_t side, std::vector<Ratio>& ratios) {
  constexpr double kGoal = 1.3;
  const std::string at = model.name + " 64 views of " + std::to_string(side) + " ";
  add(at + "one by one", [&model, side](benchmark::State& state) {
    ManyViews views(model, "gpu", side);
    for (auto _ : state) views.one_by_one();
  });
  add(at + "together", [&model, side](benchmark::State& state) {
    ManyViews views(model, "gpu", side);
    for (auto _ : state) views.together();
  });
  ratios.push_back({at + "together / one by one", at + "one by one", at + "together", kGoal});
}

int run_all(int argc, char** argv) {
  const std::vector<std::unique_ptr<Model>> all = models();
  std::vector<Ratio> ratios;
  for (const auto& model : all) {
    for (const std::uint32_t side : {256U, 512U, 1024U}) register_model(*model, side, ratios);
    for (const std::uint32_t side : {64U, 128U}) register_batches(*model, side, ratios);
  }
  return run(argc, argv, ratios);
}

}  // namespace
}  // namespace glidar::bench

int main(int argc, char** argv) {
  return glidar::bench::run_all(argc, argv);
}

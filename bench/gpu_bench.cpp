// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Times of the steps of the OpenGL renderer on a graphics device (selected by
// GLIDAR_GRAPHICS_DEVICE), and of casting in compute shaders. Medians. The clock of a software
// driver counts rasterisation only.
#include "compute_caster.hpp"
#include "compute_shaders.hpp"
#include "many_views.hpp"

#include <glidar/math/thread_pool.hpp>
#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/triangle_id_drawing.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

namespace glidar::bench {
namespace {

constexpr int kRepetitions = 9;
constexpr int kWarmUp = 2;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double median_seconds(const auto& action, int repetitions = kRepetitions) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  for (int i = 0; i < kWarmUp + repetitions; ++i) {
    const Clock::time_point start = Clock::now();
    action();
    if (i >= kWarmUp) {
      seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
  }
  return median(seconds);
}

/// Times by the device's clock.
double median_device_seconds(const auto& action) {
  GLuint query = 0;
  glGenQueries(1, &query);
  std::vector<double> seconds;
  for (int i = 0; i < kWarmUp + kRepetitions; ++i) {
    glBeginQuery(GL_TIME_ELAPSED, query);
    action();
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    if (i >= kWarmUp) seconds.push_back(1e-9 * static_cast<double>(nanoseconds));
  }
  glDeleteQueries(1, &query);
  return median(seconds);
}

void print_transfer() {
  opengl::EglContext context(chosen_device());
  const opengl::ScopedContext use(context);
  std::printf("device: %s\n", std::bit_cast<const char*>(glGetString(GL_RENDERER)));
  constexpr std::uint32_t kSide = 2048;
  constexpr double kBytes = 4.0 * kSide * kSide;
  std::vector<std::uint32_t> host(std::size_t{kSide} * kSide);
  opengl::Buffer buffer;
  glBindBuffer(GL_COPY_READ_BUFFER, buffer.name());
  glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(kBytes), host.data(), GL_STATIC_DRAW);
  const double transfer_s = median_seconds([&] {
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(kBytes), host.data());
  });
  opengl::TriangleIdTarget target;
  target.begin({kSide, kSide, 1});
  const double readback_s = median_seconds([&] {
    target.draw_into(0);
    glFinish();
    target.start_reading();
    const auto numbers = target.triangle_ids();
    std::copy(numbers.begin(), numbers.end(), host.begin());
    target.end_reading();
  });
  const double clear_s = median_seconds([&] {
    target.draw_into(0);
    glFinish();
  });
  std::printf("transfer of a buffer     %8.2f GB/s\n", 1e-9 * kBytes / transfer_s);
  std::printf("readback of a picture    %8.2f GB/s (%.2f of it)\n",
              1e-9 * kBytes / (readback_s - clear_s), transfer_s / (readback_s - clear_s));
}

/// Vertex work is the time without rasterisation; host work is the time of a cast beyond drawing
/// and reading.
void print_breakdown(const Model& model, std::uint32_t side) {
  const Beams beams = make_beams(pinhole_from_fov(side, side, kFov_rad));
  const CastRequest request{.beams = beams,
                            .world_from_sensor = model.world_from_sensor,
                            .hit_columns = {.normal = true}};
  const auto renderer = make_renderer(model.scene, options("opengl"));
  Hits hits;
  const double cast_s = median_seconds([&] { renderer->cast(request, hits); });

  opengl::EglContext context(chosen_device());
  const opengl::ScopedContext use(context);
  Resolver resolver(model.scene);
  resolver.set_poses(model.world_from_sensor, {});
  const opengl::TriangleIdDrawing drawing(model.scene);
  opengl::TriangleIdTarget target;
  target.begin({side, side, 1});
  const auto [near_m, far_m] = planes_around(model);
  const auto draw = [&, depths = DepthRange{near_m, far_m}] {
    target.draw_into(0);
    drawing.draw(request, resolver, {0, 0, side, side}, depths);
  };
  const double draw_s = median_device_seconds(draw);
  const double draw_wall_s = median_seconds([&] {
    draw();
    glFinish();
  });
  glEnable(GL_RASTERIZER_DISCARD);
  const double vertex_s = median_device_seconds(draw);
  const double vertex_wall_s = median_seconds([&] {
    draw();
    glFinish();
  });
  glDisable(GL_RASTERIZER_DISCARD);
  const double transfer_s = median_device_seconds([&] { target.start_reading(); });
  const double read_wall_s = median_seconds([&] {
    target.start_reading();
    target.triangle_ids();
    target.end_reading();
  });
  std::printf("%s %u: %.1f frames/s\n", model.name.c_str(), side, 1.0 / cast_s);
  std::printf("  device's clock: vertices %.3f ms, fragments %.3f ms, transfer %.3f ms\n",
              1e3 * vertex_s, 1e3 * (draw_s - vertex_s), 1e3 * transfer_s);
  std::printf(
      "  wall clock: vertices %.3f ms, fragments %.3f ms, reading %.3f ms, the rest of the cast "
      "%.3f ms\n",
      1e3 * vertex_wall_s, 1e3 * (draw_wall_s - vertex_wall_s), 1e3 * read_wall_s,
      1e3 * (cast_s - draw_wall_s - read_wall_s));
}

void print_batches(const Model& model, std::uint32_t side) {
  constexpr int kFew = 3;  // of many views each
  ManyViews views(model, "opengl", side);
  const double single_s = median_seconds([&] { views.one_by_one(); }, kFew);
  const double batch_s = median_seconds([&] { views.together(); }, kFew);
  std::printf("%s %u: %.0f frames/s one by one, %.0f in batches of %zu (%.1f batches/s)\n",
              model.name.c_str(), side, ManyViews::kViews / single_s, ManyViews::kViews / batch_s,
              ManyViews::kViews, 1.0 / batch_s);
}

bool is_software() {
  opengl::EglContext context(chosen_device());
  const opengl::ScopedContext use(context);
  const std::string_view name = std::bit_cast<const char*>(glGetString(GL_RENDERER));
  return name.find("llvmpipe") != std::string_view::npos;
}

/// Agreement of a batch with rays.
struct Comparison {
  std::size_t beams = 0;
  std::size_t hits = 0;
  std::size_t undecided = 0;
  std::size_t different = 0;
};

void compare_with_rays(const Model& model, const Beams& beams, const std::vector<Pose>& poses,
                       const BatchHits& batch, Comparison& result) {
  const auto rays = make_renderer(model.scene, {.kind = "rays"});
  Hits hits;
  result.undecided += batch.undecided;
  for (std::size_t view = 0; view < poses.size(); ++view) {
    rays->cast({.beams = beams, .world_from_sensor = poses[view]}, hits);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const std::size_t place = view * beams.size() + i;
      const bool is_hit = hits.primitive[i] != kInvalidId;
      const bool is_same = batch.primitive[place] == hits.primitive[i] &&
                           (!is_hit || std::bit_cast<std::uint64_t>(batch.range_m[place]) ==
                                           std::bit_cast<std::uint64_t>(hits.range_m[i]));
      ++result.beams;
      result.hits += is_hit ? 1 : 0;
      result.different += is_same ? 0 : 1;
    }
  }
}

/// Batches of random views, cast by compute shaders while those before are read back and re-tested.
void print_compute(const Model& model, std::uint32_t side) {
  const bool is_slow = is_software();
  const std::size_t views = is_slow ? 1 : 256;
  constexpr std::uint64_t kBatches = 4;
  const Beams beams = make_beams(pinhole_from_fov(side, side, kFov_rad));
  ComputeCaster caster(model.scene, beams, views);
  std::vector<std::vector<Pose>> poses;
  Comparison all;
  for (std::uint64_t i = 0; i < kBatches; ++i) {
    poses.push_back(poses_around(model, i + 1, views));
    caster.start(poses.back());
    compare_with_rays(model, beams, poses.back(), caster.finish(), all);
  }
  const std::size_t rounds = is_slow ? 1 : 4;  // through the batches, in one measurement
  const double seconds = median_seconds([&] {
    for (std::size_t i = 0; i < rounds * kBatches + ComputeCaster::kUnderWay - 1; ++i) {
      if (i < rounds * kBatches) caster.start(poses[i % kBatches]);
      if (i + 1 >= ComputeCaster::kUnderWay) caster.finish();
    }
  });
  const double kernel_s = median_device_seconds([&] {
    caster.start(poses[0]);
    caster.finish();
  });
  const double rounds_s = seconds / static_cast<double>(rounds);
  std::printf(
      "%s %u, cast by compute shaders: %.1f million hits/s, %.1f million beams/s, %.0f views/s; "
      "%.3f ms a batch of %zu on the device's clock\n",
      model.name.c_str(), side, 1e-6 * static_cast<double>(all.hits) / rounds_s,
      1e-6 * static_cast<double>(all.beams) / rounds_s,
      static_cast<double>(kBatches * views) / rounds_s, 1e3 * kernel_s, views);
  std::printf("  %zu of %zu beams differ from rays; %.2e of them in doubt\n", all.different,
              all.beams, static_cast<double>(all.undecided) / static_cast<double>(all.beams));
}

void run_all() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  print_transfer();
  for (const auto& model : models()) {
    for (const std::uint32_t side : {256U, 512U, 1024U}) print_breakdown(*model, side);
    print_batches(*model, 128);
    if (const std::string missing = ComputeCaster::missing(); missing.empty()) {
      print_compute(*model, 128);
      if (!is_software()) print_compute(*model, 512);
    } else {
      std::printf("no casting by compute shaders: %s\n", missing.c_str());
    }
  }
}

}  // namespace
}  // namespace glidar::bench

int main() {
  glidar::bench::run_all();
  return 0;
}

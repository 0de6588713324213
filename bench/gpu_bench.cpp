// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Speed of the gpu renderer on a graphics device (selected by GLIDAR_GRAPHICS_DEVICE): batches of
// random views, with ranges only and with normals, which the host computes. Medians.
#include "many_views.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <string_view>

namespace glidar::bench {
namespace {

constexpr std::uint64_t kBatches = 4;

double median_seconds(const auto& action) {
  using Clock = std::chrono::steady_clock;
  constexpr int kRepetitions = 9;
  constexpr int kWarmUp = 2;
  std::vector<double> seconds;
  for (int i = 0; i < kWarmUp + kRepetitions; ++i) {
    const Clock::time_point start = Clock::now();
    action();
    if (i >= kWarmUp) {
      seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

/// Prints the speed of copying a buffer to the host, and whether the device is software.
bool print_device() {
  opengl::EglContext context(chosen_device());
  const opengl::ScopedContext use(context);
  const std::string_view name = std::bit_cast<const char*>(glGetString(GL_RENDERER));
  constexpr GLsizeiptr kBytes = GLsizeiptr{16} << 20U;
  std::vector<std::uint8_t> host(static_cast<std::size_t>(kBytes));
  opengl::Buffer buffer;
  glBindBuffer(GL_COPY_READ_BUFFER, buffer.name());
  glBufferData(GL_COPY_READ_BUFFER, kBytes, host.data(), GL_STATIC_DRAW);
  const double seconds =
      median_seconds([&] { glGetBufferSubData(GL_COPY_READ_BUFFER, 0, kBytes, host.data()); });
  std::printf("device: %s; transfer of a buffer %.2f GB/s\n", name.data(),
              1e-9 * static_cast<double>(kBytes) / seconds);
  return name.find("llvmpipe") != std::string_view::npos;
}

/// Batches of requests and their hits.
struct Batches {
  Beams beams;
  std::vector<std::vector<CastRequest>> requests;
  std::vector<Hits> hits;
  std::vector<Hits*> all;

  Batches(const Model& model, std::uint32_t side, std::size_t views, HitColumnMask columns)
      : beams(make_beams(pinhole_from_fov(side, side, kFov_rad))), hits(views) {
    for (std::uint64_t batch = 0; batch < kBatches; ++batch) {
      requests.emplace_back();
      for (const Pose& pose : poses_around(model, batch + 1, views)) {
        requests.back().push_back(
            {.beams = beams, .world_from_sensor = pose, .hit_columns = columns});
      }
    }
    for (Hits& h : hits) all.push_back(&h);
  }
};

/// Hits, and beams whose triangle or range differs.
struct Comparison {
  std::size_t found = 0;
  std::size_t different = 0;
};

void compare(const Hits& hits, const Hits& expected, Comparison& sum) {
  for (std::size_t beam = 0; beam < expected.primitive.size(); ++beam) {
    const bool is_hit = expected.primitive[beam] != kInvalidId;
    sum.found += is_hit ? 1 : 0;
    sum.different += hits.primitive[beam] != expected.primitive[beam] ||
                             (is_hit && hits.range_m[beam] != expected.range_m[beam])
                         ? 1
                         : 0;
  }
}

void print_batches(const Model& model, std::uint32_t side, bool is_software, bool with_normals) {
  Batches batches(model, side, is_software ? 4 : 256, {.normal = with_normals});
  const auto gpu = make_renderer(model.scene, options("gpu"));
  const auto rays = make_renderer(model.scene, options("rays"));
  Comparison sum;
  Hits expected;
  for (const std::vector<CastRequest>& requests : batches.requests) {
    gpu->cast_batch(requests, batches.all);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      rays->cast(requests[i], expected);
      compare(batches.hits[i], expected, sum);
    }
  }
  const double seconds = median_seconds([&] {
    for (const auto& requests : batches.requests) gpu->cast_batch(requests, batches.all);
  });
  const auto views = static_cast<double>(kBatches * batches.hits.size());
  std::printf("%s %u, %s: %.1f million hits/s, %.1f million beams/s; %zu differ from rays\n",
              model.name.c_str(), side, with_normals ? "normals" : "ranges",
              1e-6 * static_cast<double>(sum.found) / seconds,
              1e-6 * views * static_cast<double>(batches.beams.size()) / seconds, sum.different);
}

void run_all() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const bool is_software = print_device();
  for (const auto& model : models()) {
    for (const std::uint32_t side : {128U, 512U}) {
      print_batches(*model, side, is_software, false);
      print_batches(*model, side, is_software, true);
    }
  }
}

}  // namespace
}  // namespace glidar::bench

int main() {
  glidar::bench::run_all();
  return 0;
}

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/scan_raster/scanner.hpp>

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>

#include <cstring>

namespace glidar::testing {
namespace {

template <class T>
void expect_same_bytes(const std::vector<T>& found, const std::vector<T>& expected,
                       const char* column) {
  ASSERT_EQ(found.size(), expected.size()) << column;
  if (found.empty()) return;
  if (std::memcmp(found.data(), expected.data(), found.size() * sizeof(T)) == 0) return;
  std::size_t differ = 0;
  std::size_t first = found.size();
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::memcmp(&found[i], &expected[i], sizeof(T)) == 0) continue;
    ++differ;
    first = std::min(first, i);
  }
  ADD_FAILURE() << column << ": " << differ << " of " << found.size()
                << " beams differ, the first is " << first;
}

}  // namespace

Beams lens_beams(std::uint32_t width, std::uint32_t height, double focal_px,
                 const Distortion& distortion) {
  return make_beams(Pinhole{.intrinsics = {.width = width,
                                           .height = height,
                                           .fx = focal_px,
                                           .fy = 1.1 * focal_px,
                                           .cx = 0.45 * width,
                                           .cy = 0.55 * height},
                            .distortion = distortion});
}

Beams preset_beams(const char* name) {
  return make_beams(load_sensor_file(find_sensor_file(name)));
}

std::size_t expect_same_hits(const Hits& found, const Hits& expected) {
  expect_same_bytes(found.instance, expected.instance, "instance");
  expect_same_bytes(found.primitive, expected.primitive, "primitive");
  expect_same_bytes(found.range_m, expected.range_m, "range");
  expect_same_bytes(found.normal, expected.normal, "normal");
  expect_same_bytes(found.shading_normal, expected.shading_normal, "shading normal");
  expect_same_bytes(found.cos_incidence, expected.cos_incidence, "cosine of incidence");
  expect_same_bytes(found.cos_shading, expected.cos_shading, "cosine of shading");
  expect_same_bytes(found.barycentrics, expected.barycentrics, "barycentrics");
  expect_same_bytes(found.colour, expected.colour, "colour");
  expect_same_bytes(found.diffuse, expected.diffuse, "diffuse");
  expect_same_bytes(found.object_point_m, expected.object_point_m, "object point");
  expect_same_bytes(found.noise_scale, expected.noise_scale, "noise scale");
  expect_same_bytes(found.depth_m, expected.depth_m, "depth");
  expect_same_bytes(found.reflectance, expected.reflectance, "reflectance");
  std::size_t hits = 0;
  for (const std::uint32_t instance : expected.instance) hits += instance == kInvalidId ? 0 : 1;
  return hits;
}

RasterAndRays::RasterAndRays(const Scene& scene)
    : raster_(make_renderer(scene, {.kind = "raster", .threads = 2})),
      rays_(make_renderer(scene, {.kind = "rays", .threads = 2})) {}

std::size_t RasterAndRays::expect_same(const CastRequest& request) const {
  Hits found;
  Hits expected;
  raster_->cast(request, found);
  rays_->cast(request, expected);
  return expect_same_hits(found, expected);
}

std::size_t RasterAndRays::expect_same(const Beams& beams, const Pose& world_from_sensor) const {
  return expect_same(
      {.beams = beams, .world_from_sensor = world_from_sensor, .hit_columns = kAllHitColumns});
}

std::size_t expect_same_as_rays(const Scene& scene, const CastRequest& request) {
  return RasterAndRays(scene).expect_same(request);
}

std::size_t expect_same_as_rays(const Scene& scene, const Beams& beams,
                                const Pose& world_from_sensor) {
  return RasterAndRays(scene).expect_same(beams, world_from_sensor);
}

}  // namespace glidar::testing

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

// Counted, to show that a frame in the steady state allocates nothing. Not inlined: there GCC 12
// sees memory of new given to free, and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace glidar {
namespace {

/// A depth camera 5 m before a plane of 2 m x 2 m.
struct Stage {
  Scene scene = testing::scene_of(make_builtin_model("plane"));
  Sensor sensor;
  Beams beams;
  Motion motion;
  std::unique_ptr<Renderer> renderer;

  explicit Stage(std::uint32_t size = 16) {
    sensor.optics = pinhole_from_fov(size, size, 0.5);
    beams = make_beams(sensor);
    motion =
        static_motion(scene, look_at({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY()));
    renderer = make_renderer(scene, {.threads = 2});
  }
  Frame shoot(const HitColumnMask& hit_columns = {}) {
    Frame frame;
    testing::simulate({scene, sensor, beams, motion, *renderer}, hit_columns, frame);
    return frame;
  }
};

TEST(Simulate, MeasuresAPlaneExactly) {
  Stage stage;
  const Frame frame = stage.shoot();
  std::size_t hits = 0;
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != Status::hit) {
      EXPECT_EQ(frame.status[i], Status::miss);
      EXPECT_TRUE(std::isnan(frame.range_m[i]));
      EXPECT_EQ(frame.intensity[i], 0.0F);
      continue;
    }
    ++hits;
    EXPECT_NEAR(frame.range_m[i] * stage.beams.directions[i].z(), 5.0, 1e-14);
  }
  EXPECT_GT(hits, 100U);
  EXPECT_LT(hits, 256U);  // the field of view is wider than the plane
}

TEST(Simulate, HasTheIntensityOfThePhongModelOnAPlane) {
  Stage stage;
  const Frame frame = stage.shoot();
  const Material& material = stage.scene.materials[stage.scene.instances[0].materials[0]];
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != Status::hit) continue;
    const double d = frame.range_m[i];
    const double cosine = stage.beams.directions[i].z();
    const double a = 1.0 / (1.0 + 1e-4 * d + 1e-8 * d * d);
    const double c = 0.2 * luminance(material.ambient) + luminance(material.diffuse) * cosine +
                     luminance(material.specular) * std::pow(cosine, material.shininess);
    EXPECT_NEAR(frame.intensity[i], a * c, 2e-6);
  }
}

TEST(Simulate, ReportsSurfacesOutsideTheDepthLimitsAndKeepsTheGroundTruth) {
  Stage stage;
  stage.sensor.limits = {.near_m = 6.0};
  Frame frame = stage.shoot();
  const std::size_t middle = 16 * 8 + 8;
  EXPECT_EQ(frame.status[middle], Status::too_near);
  EXPECT_TRUE(std::isnan(frame.range_m[middle]));
  EXPECT_FALSE(std::isnan(frame.ground_truth.range_m[middle]));
  stage.sensor.limits = {.far_m = 4.0};
  frame = stage.shoot();
  EXPECT_EQ(frame.status[middle], Status::too_far);
}

TEST(Simulate, ReportsInvalidPixels) {
  Stage stage;
  stage.beams.directions[3].setConstant(std::nan(""));
  stage.beams.pinhole.reset();  // no longer its directions
  EXPECT_EQ(stage.shoot().status[3], Status::invalid_pixel);
}

TEST(Simulate, AllocatesNothingInTheSteadyState) {
  Stage stage(64);
  stage.sensor.noise = {PointingJitter{.sigma_azimuth_rad = 1e-4}, RangeGaussian{.sigma_m = 0.01},
                        KinectV1{}, Dropout{.probability = 0.1}};
  Simulator simulator(stage.scene, stage.sensor, *stage.renderer);
  const HitColumnMask hit_columns{.depth = true, .normal = true, .object_point = true};
  Frame frame;
  for (int warm_up = 0; warm_up < 3; ++warm_up)
    simulator.simulate(stage.motion, hit_columns, frame);
  const std::size_t before = allocations;
  for (int i = 0; i < 10; ++i) simulator.simulate(stage.motion, hit_columns, frame);
  EXPECT_EQ(allocations - before, 0U);
}

/// Spheres that overlap, one of them in two parts with origins of their own.
Scene overlapping_parts() {
  Scene scene = testing::scene_of(make_builtin_model("sphere"));
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_object.translation().x() = 0.5;
  Mesh parts = scene.meshes[0];
  const auto vertices = static_cast<std::uint32_t>(parts.positions_m.size());
  const auto triangles = static_cast<std::uint32_t>(parts.triangles.size());
  for (std::uint32_t i = 0; i < vertices; ++i) {
    parts.positions_m.push_back(Eigen::Vector3f(parts.positions_m[i]));
    if (!parts.normals.empty()) parts.normals.push_back(Eigen::Vector3f(parts.normals[i]));
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Triangle& one = parts.triangles[t];
    parts.triangles.push_back({one[0] + vertices, one[1] + vertices, one[2] + vertices});
  }
  parts.origins = {{0, 0, parts.origin_m}, {vertices, triangles, {0.0, 0.7, 0.0}}};
  parts.origin_m.setZero();
  scene.instances[1].mesh = 1;
  scene.meshes.push_back(std::move(parts));
  scene.sources.emplace_back();
  return scene;
}

TEST(Simulate, AllocatesNothingInTheSteadyStateForScannersWhoseBeamsChange) {
  const Scene scene = overlapping_parts();
  for (const char* kind : {"rays", "auto"}) {
    const std::unique_ptr<Renderer> renderer = make_renderer(scene, {.kind = kind, .threads = 1});
    Sensor sensor;
    LineScan& raster = sensor.optics.emplace<LineScan>();
    for (int i = 0; i < 300; ++i) raster.azimuths_rad.push_back(0.01 * i - 1.5);
    for (int i = 0; i < 30; ++i) raster.elevations_rad.push_back(0.01 * i - 0.15);
    Beams beams = make_beams(sensor);
    CastRequest request{.beams = beams, .hit_columns = {.normal = true}};
    request.world_from_sensor.translation().x() = -4.0;
    Hits hits;
    const auto cast = [&](int times) {
      for (int i = 0; i < times; ++i) {
        std::swap(beams.directions[5], beams.directions[6]);
        renderer->cast(request, hits);
      }
    };
    cast(3);
    EXPECT_GT(std::count(hits.instance.begin(), hits.instance.end(), 1U), 10);
    const std::size_t before = allocations;
    cast(10);
    EXPECT_EQ(allocations - before, 0U) << kind;
  }
}

TEST(Simulate, AllocatesNothingInTheSteadyStateForOverlappingPartsOfMeshes) {
  const Scene scene = overlapping_parts();
  for (const char* kind : {"raster", "rays"}) {
    const std::unique_ptr<Renderer> renderer = make_renderer(scene, {.kind = kind, .threads = 1});
    Sensor sensor;
    sensor.optics = pinhole_from_fov(64, 64, 0.5);
    const Beams beams = make_beams(sensor);
    CastRequest request{.beams = beams, .hit_columns = {.normal = true}};
    request.world_from_sensor.translation().z() = -8.0;
    Hits hits;
    for (int warm_up = 0; warm_up < 3; ++warm_up) renderer->cast(request, hits);
    EXPECT_GT(std::count(hits.instance.begin(), hits.instance.end(), 1U), 10);
    const std::size_t before = allocations;
    for (int i = 0; i < 10; ++i) renderer->cast(request, hits);
    EXPECT_EQ(allocations - before, 0U) << kind;
  }
}

TEST(Simulate, ReportsProgressAndMeasuresTheSame) {
  Stage stage(512);
  std::vector<double> reported;
  Frame frame;
  testing::simulate({.scene = stage.scene,
                     .sensor = stage.sensor,
                     .beams = stage.beams,
                     .motion = stage.motion,
                     .renderer = *stage.renderer,
                     .progress = [&](double fraction) { reported.push_back(fraction); }},
                    {}, frame);
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  EXPECT_GT(reported.size(), 5U);
  EXPECT_GT(reported.front(), 0.0);
  EXPECT_LT(reported.front(), 0.5);
  EXPECT_EQ(reported.back(), 1.0);
  const Frame silent = stage.shoot();
  EXPECT_EQ(std::memcmp(frame.range_m.data(), silent.range_m.data(),
                        silent.range_m.size() * sizeof(double)),
            0);
  EXPECT_EQ(frame.intensity, silent.intensity);
}

}  // namespace
}  // namespace glidar

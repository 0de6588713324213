// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Random scenes of difficult triangles: every renderer reports the bits of rays, and assertions in
// the library hold: no renderer is sure of a hit that the hit rule refuses.
#include <render/renderer_suite.hpp>
#include <render/same_hits.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace glidar {
namespace {

using testing::camera_beams;
using testing::Draws;
using testing::expect_same_hits;
using testing::turned;

double between(Draws& draws, double low, double high) {
  return low + (high - low) * draws.next();
}

std::uint32_t below(Draws& draws, std::size_t end) {
  return static_cast<std::uint32_t>(
      std::min(static_cast<std::size_t>(draws.next() * static_cast<double>(end)), end - 1));
}

/// A new vertex of a mesh: anywhere, at one that exists, next to one, or on a coarse grid, on which
/// vertices coincide and triangles are coplanar.
Eigen::Vector3f next_vertex(Draws& draws, const Mesh& mesh) {
  Eigen::Vector3d p(between(draws, -1, 1), between(draws, -1, 1), between(draws, -1, 1));
  const std::uint32_t kind = below(draws, 4);
  if (kind == 1) p = (4.0 * p).array().round() / 4.0;
  if (kind >= 2 && !mesh.positions_m.empty()) {
    const Eigen::Vector3f& other = mesh.positions_m[below(draws, mesh.positions_m.size())];
    const double apart = kind == 2 ? 0.0 : std::pow(10.0, between(draws, -8.0, -1.0));
    p = other.cast<double>() + apart * p;
  }
  return p.cast<float>();
}

/// Triangles of new and used vertices: neighbours, slivers, duplicates and some without area.
Mesh random_mesh(Draws& draws, std::uint32_t triangles) {
  Mesh mesh;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    Triangle corners{};
    for (std::uint32_t& corner : corners) {
      if (mesh.positions_m.size() > 3 && draws.next() < 0.5) {
        corner = below(draws, mesh.positions_m.size());
        continue;
      }
      corner = static_cast<std::uint32_t>(mesh.positions_m.size());
      mesh.positions_m.push_back(next_vertex(draws, mesh));
    }
    mesh.triangles.push_back(corners);
    if (t % 7 == 6) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    if (t % 7 == 6) mesh.triangles.push_back(corners);
  }
  return mesh;
}

/// Up to four instances of up to two meshes, of different sizes and at different distances, some in
/// the same place.
Scene random_scene(Draws& draws, const Eigen::Vector3d& centre) {
  Scene scene = testing::builtin_scene("box");
  scene.meshes[0] = random_mesh(draws, 1 + below(draws, 200));
  scene.meshes.push_back(random_mesh(draws, 1 + below(draws, 3)));
  scene.sources.push_back({});
  const Instance first = scene.instances[0];
  scene.instances.clear();
  const std::uint32_t count = 1 + below(draws, 4);
  for (std::uint32_t i = 0; i < count; ++i) {
    Instance instance = first;
    instance.mesh = below(draws, 2);
    instance.scale = draws.next() < 0.5 ? 1.0 : std::pow(10.0, between(draws, -3.0, 3.0));
    const double away = instance.scale * between(draws, 0.0, 2.0);
    instance.world_from_object =
        turned(between(draws, 0.0, 6.0), draws.direction(), centre + away * draws.direction());
    if (i > 0 && draws.next() < 0.3) instance = scene.instances.back();
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Looks at the scene from one of its vertices, from beside it or from far away.
Pose random_view(Draws& draws, const Scene& scene, const Eigen::Vector3d& centre) {
  const Instance& at = scene.instances[below(draws, scene.instances.size())];
  const Mesh& mesh = scene.meshes[at.mesh];
  const Eigen::Vector3d vertex =
      mesh.positions_m[below(draws, mesh.positions_m.size())].cast<double>();
  const std::array distances = {0.0, 1.5, 1.5, 1000.0};
  const Eigen::Vector3d on_vertex = at.world_from_object * (at.scale * vertex);
  const double away = at.scale * distances[below(draws, distances.size())];
  const Eigen::Vector3d eye = on_vertex + away * draws.direction();
  const Eigen::Vector3d target = centre + 0.3 * at.scale * draws.direction();
  return look_at(eye, target, draws.direction());
}

Hits cast_with(const char* kind, const Scene& scene, const CastRequest& request) {
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})->cast(request, hits);
  return hits;
}

/// Casts by rays and by others; returns the number of hits.
std::size_t compare(const Scene& scene, const Beams& beams, const Pose& pose,
                    const std::vector<const char*>& others) {
  const CastRequest request{
      .beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns};
  const Hits rays = cast_with("rays", scene, request);
  std::size_t hits = 0;
  for (const char* kind : others) {
    SCOPED_TRACE(kind);
    hits = expect_same_hits(cast_with(kind, scene, request), rays);
  }
  return hits;
}

constexpr std::uint64_t kScenes = 120;

/// A random scene, every third far from the origin, and a camera that looks at it.
struct CameraView {
  Scene scene;
  Beams beams;
  Pose pose;
};

CameraView random_camera_view(std::uint64_t seed) {
  Draws draws(seed);
  const Eigen::Vector3d centre = (seed % 3 == 0 ? 1e6 : 0.0) * draws.direction();
  const Scene scene = random_scene(draws, centre);
  const Beams beams = camera_beams(96, 64, std::pow(10.0, between(draws, 1.5, 3.0)));
  return {scene, beams, random_view(draws, scene, centre)};
}

TEST(RandomScenes, CamerasSeeTheSameBitsByEveryRenderer) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const auto [scene, beams, pose] = random_camera_view(seed);
    hits += compare(scene, beams, pose, {"raster", "auto"});
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, 100'000U);
}

// Most scenes have several instances, and beams that only the processor can decide. Drivers compile
// shaders for every renderer, so there are fewer scenes.
TEST(RandomScenes, AGpuSeesTheSameBitsForEveryKindOfRequest) {
  GLIDAR_NEEDS_GPU();
  constexpr std::uint64_t kGpuScenes = 16;
  std::size_t hits = 0;
  for (std::uint64_t seed = 1; seed <= kGpuScenes; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const auto [scene, beams, pose] = random_camera_view(seed);
    Draws draws(seed);
    Beams loose = beams;  // as the beams of a moving scanner
    loose.pinhole.reset();
    loose.rows = 1;
    loose.cols = static_cast<std::uint32_t>(beams.size());
    for (std::size_t i = 0; i < beams.size(); ++i) {
      loose.origins_m.push_back(1e-3 * draws.next() * draws.direction());
    }
    std::vector<InstanceRange> targets;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const std::uint32_t begin = below(draws, scene.instances.size());
      targets.push_back({begin, begin + 1 + below(draws, scene.instances.size() - begin)});
    }
    std::vector<Pose> moved;
    for (const Instance& instance : scene.instances) moved.push_back(instance.world_from_object);
    moved[0] = moved[0] * turned(0.1, draws.direction(), 0.1 * draws.direction());
    const std::vector<CastRequest> requests = {
        {.beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns},
        {.beams = beams, .world_from_sensor = pose, .hit_columns = {.depth = true}},
        {.beams = beams, .world_from_sensor = pose, .world_from_instance = moved},
        {.beams = beams, .world_from_sensor = pose, .cull_back_faces = true},
        {.beams = loose, .world_from_sensor = pose, .hit_columns = {.depth = true}},
        {.beams = loose, .world_from_sensor = pose, .targets = targets},
        {.beams = loose,
         .world_from_sensor = pose,
         .hit_columns = {.normal = true},
         .cull_back_faces = true,
         .targets = targets}};
    std::vector<Hits> found(requests.size());
    std::vector<Hits*> all;
    for (Hits& one : found) all.push_back(&one);
    make_renderer(scene, {.kind = "gpu", .threads = 2})->cast_batch(requests, all);
    const auto rays = make_renderer(scene, {.kind = "rays", .threads = 2});
    for (std::size_t i = 0; i < requests.size(); ++i) {
      SCOPED_TRACE(::testing::Message() << "request " << i);
      Hits expected;
      rays->cast(requests[i], expected);
      hits += expect_same_hits(found[i], expected);
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, 100'000U);
}

// Without corners, planes are stored; with them, planes are computed from corners.
TEST(RandomScenes, ColumnsHaveTheSameBitsAloneAndWithAllOthers) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const auto [scene, beams, pose] = random_camera_view(seed);
    CastRequest request{.beams = beams, .world_from_sensor = pose, .hit_columns = {.normal = true}};
    for (const char* kind : {"raster", "rays"}) {
      SCOPED_TRACE(kind);
      const auto renderer = make_renderer(scene, {.kind = kind});
      Hits alone;
      Hits all;
      Hits alone_again;
      request.hit_columns = {.normal = true};
      renderer->cast(request, alone);
      request.hit_columns = kAllHitColumns;
      renderer->cast(request, all);
      request.hit_columns = {.normal = true};
      renderer->cast(request, alone_again);
      const auto expect_same = [](const auto& a, const auto& b) {
        ASSERT_EQ(a.size(), b.size());
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
      };
      expect_same(alone.range_m, all.range_m);
      expect_same(alone.normal, all.normal);
      expect_same(alone.primitive, all.primitive);
      expect_same(alone.range_m, alone_again.range_m);
      expect_same(alone.normal, alone_again.normal);
      hits += static_cast<std::size_t>(
          std::count_if(all.instance.begin(), all.instance.end(),
                        [](std::uint32_t instance) { return instance != kInvalidId; }));
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, 100'000U);
}

}  // namespace
}  // namespace glidar

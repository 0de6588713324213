// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Sub-rays that are searched as footprints hit what they hit alone, bit for bit.
#include <glidar/render/rays/footprint_search.hpp>

#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/rays/rays_renderer.hpp>
#include <render/renderer_suite.hpp>
#include <support/parameter_name.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace glidar {
namespace {

using testing::Draws;
using testing::loose_beams;
using testing::turned;

/// A scene of random triangles, and the footprints that are cast into it.
struct FootprintCase {
  std::string name;
  double min_size = 0.03;  ///< of triangles; the largest are 1.5, in a ball of radius 2
  std::size_t instances = 1;
  double scale_decades = 0.0;  ///< of instances' scales
  double distance = 3.0;       ///< of most origins from the middle
  double max_slope = 0.02;
  std::uint32_t sub_rays = 7;
  bool has_masks = false;
  bool culls = false;
};

void PrintTo(const FootprintCase& c, std::ostream* out) {
  *out << c.name;
}

Eigen::Vector3f point(Draws& draws, double size) {
  return (size * draws.next() * draws.direction()).cast<float>();
}

/// Triangles of all sizes through each other: slivers, coplanar ones, neighbours, and copies with
/// their corners in another order.
Mesh make_soup(const FootprintCase& c, Draws& draws) {
  Mesh mesh;
  for (unsigned t = 0; t < 150; ++t) {
    const double size = c.min_size * std::pow(1.5 / c.min_size, draws.next());
    const bool is_flat = t % 3 == 0;
    std::array<Eigen::Vector3f, 3> corner;
    const Eigen::Vector3f at = point(draws, 2.0);
    for (Eigen::Vector3f& p : corner) p = at + point(draws, size);
    if (t % 7 == 0) corner[2] = corner[0] + 1.0001F * (corner[1] - corner[0]);
    if (is_flat) {
      for (Eigen::Vector3f& p : corner) p.z() = -0.5F;
    }
    const auto base = static_cast<std::uint32_t>(mesh.positions_m.size());
    mesh.positions_m.insert(mesh.positions_m.end(), corner.begin(), corner.end());
    mesh.triangles.push_back({base, base + 1, base + 2});
    if (t % 11 == 0) mesh.triangles.push_back({base + 2, base, base + 1});
    if (t % 4 != 0) continue;
    mesh.positions_m.emplace_back(corner[0] + corner[1] - corner[2]);  // a parallelogram
    mesh.triangles.push_back({base, base + 3, base + 1});
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.material_slots.push_back(static_cast<std::uint16_t>(t % 2));
  }
  return mesh;
}

Scene make_scene(const FootprintCase& c, Draws& draws) {
  Scene scene;
  scene.meshes.push_back(make_soup(c, draws));
  scene.sources.emplace_back();
  scene.materials.resize(2);
  if (c.has_masks) {  // half of the triangles let all beams pass
    scene.materials[1].alpha_cutoff = 0.5F;
    scene.materials[1].opacity = 0.25F;
  }
  for (std::size_t i = 0; i < c.instances; ++i) {
    Instance instance;
    instance.materials = {0, 1};
    instance.scale = std::pow(10.0, c.scale_decades * (draws.next() - 0.5));
    const double spread = i % 3 == 0 ? 0.0 : 2.0 * draws.next();  // some coincide
    instance.world_from_object = turned(i % 3 == 0 ? 0.0 : 6.0 * draws.next(), draws.direction(),
                                        spread * draws.direction());
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Footprints at corners, edges and anywhere, in bundles of neighbours.
Beams make_footprints(const FootprintCase& c, const Mesh& mesh, std::size_t count, Draws& draws,
                      FootprintLayout& layout) {
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins;
  Eigen::Vector3d origin;
  Eigen::Vector3d target;
  double slope = 0.0;
  const double exit = draws.next() < 0.3 ? 0.0 : 0.01 * draws.next();
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 16 == 0) {
      const double distance = draws.next() < 0.2 ? 1.5 : c.distance;
      origin = distance * (0.5 + draws.next()) * draws.direction();
      target = mesh.positions_m[static_cast<std::size_t>(
                                    draws.next() * static_cast<double>(mesh.positions_m.size()))]
                   .cast<double>();
    }
    if (i % 256 == 0) slope = c.max_slope * std::pow(10.0, -4.0 * draws.next());
    const Eigen::Vector3d middle =
        (target + 0.3 * draws.next() * draws.direction() - origin).normalized();
    for (std::uint32_t k = 0; k < c.sub_rays; ++k) {
      const double part = k == 0 ? 0.0 : 0.99;
      directions.push_back((middle + part * slope * draws.direction()).normalized());
      origins.push_back(origin + part * exit * draws.direction());
    }
  }
  layout = {.beams = c.sub_rays, .slope = 1.01 * c.max_slope, .radius_m = exit};
  return loose_beams(std::move(directions), std::move(origins));
}

/// FNV-1a of what is hit and where, over the bits.
std::uint64_t hash_of(const Hits& hits) {
  std::uint64_t hash = 1469598103934665603U;
  for (std::size_t i = 0; i < hits.instance.size(); ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    for (const std::uint64_t word :
         {std::uint64_t{i}, std::uint64_t{hits.instance[i]}, std::uint64_t{hits.primitive[i]},
          std::bit_cast<std::uint64_t>(hits.range_m[i])}) {
      hash = (hash ^ word) * 1099511628211U;
    }
  }
  return hash;
}

std::size_t count_hits(const Hits& hits) {
  return hits.instance.size() - static_cast<std::size_t>(std::count(
                                    hits.instance.begin(), hits.instance.end(), kInvalidId));
}

/// Rounds of random scenes: GLIDAR_FOOTPRINT_ROUNDS for a longer search.
std::uint64_t rounds() {
  const char* more = std::getenv("GLIDAR_FOOTPRINT_ROUNDS");
  return more == nullptr ? 2 : std::strtoull(more, nullptr, 10);
}

class FootprintSearchSuite : public ::testing::TestWithParam<FootprintCase> {};

TEST_P(FootprintSearchSuite, FindsWhatSubRaysHitAlone) {
  const FootprintCase& c = GetParam();
  std::size_t hits_found = 0;
  for (std::uint64_t round = 0; round < rounds(); ++round) {
    Draws draws(1000 * round + 7);
    const Scene scene = make_scene(c, draws);
    FootprintLayout layout;
    const Beams beams = make_footprints(c, scene.meshes[0], 5000, draws, layout);
    for (const rays::Kernel* kernel : rays::usable_kernels()) {
      ::setenv("GLIDAR_ISA", kernel->name, 1);
      const auto renderer = make_rays_renderer(scene, {.threads = 2});
      ::unsetenv("GLIDAR_ISA");
      CastRequest request{.beams = beams, .cull_back_faces = c.culls};
      Hits alone;
      Hits together;
      renderer->cast(request, alone);
      request.footprints = layout;
      renderer->cast(request, together);
      ASSERT_EQ(hash_of(together), hash_of(alone)) << kernel->name << ", round " << round;
      hits_found += count_hits(alone);
    }
  }
  EXPECT_GT(hits_found, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, FootprintSearchSuite,
    ::testing::Values(FootprintCase{.name = "one_instance"},
                      FootprintCase{.name = "wide_footprints", .max_slope = 0.09},
                      FootprintCase{.name = "two_rings", .sub_rays = 19},
                      FootprintCase{.name = "pairs", .sub_rays = 2},
                      FootprintCase{.name = "tiny_triangles", .min_size = 1e-7},
                      FootprintCase{.name = "instances", .instances = 12},
                      FootprintCase{.name = "scales", .instances = 12, .scale_decades = 6.0},
                      FootprintCase{.name = "far_instances",
                                    .instances = 5,
                                    .scale_decades = 2.0,
                                    .distance = 1e3,
                                    .max_slope = 1e-3},
                      FootprintCase{.name = "far", .distance = 1e5, .max_slope = 1e-5},
                      FootprintCase{.name = "wide_and_far", .distance = 300.0, .max_slope = 0.01},
                      FootprintCase{.name = "masks", .instances = 4, .has_masks = true},
                      FootprintCase{.name = "culling", .instances = 4, .culls = true}),
    testing::parameter_name<FootprintCase>);

TEST(FootprintSearch, SubRaysOfMissingBeamsMiss) {
  Scene scene = testing::builtin_scene("box");
  std::vector<Eigen::Vector3d> directions(21, Eigen::Vector3d::UnitX());
  for (std::size_t i = 7; i < 14; ++i) directions[i].setConstant(std::nan(""));
  const Beams beams = loose_beams(directions, {});
  const auto renderer = make_rays_renderer(scene, {.threads = 1});
  Hits hits;
  renderer->cast({.beams = beams, .footprints = {.beams = 7, .slope = 1e-3}}, hits);
  EXPECT_EQ(count_hits(hits), 14U);
  for (std::size_t i = 7; i < 14; ++i) EXPECT_EQ(hits.instance[i], kInvalidId);
}

TEST(FootprintSearch, NeedsWholeFootprints) {
  const Scene scene = testing::builtin_scene("box");
  const Beams beams = loose_beams(std::vector(8, Eigen::Vector3d(1.0, 0.0, 0.0)), {});
  const auto renderer = make_rays_renderer(scene, {.threads = 1});
  Hits hits;
  try {
    renderer->cast({.beams = beams, .footprints = {.beams = 7}}, hits);
    ADD_FAILURE() << "8 beams are no footprints of 7";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("divisor of the number of beams"), std::string::npos);
  }
}

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Hits do not depend on how beams are arranged in rows: sub-rays are cast as one row.
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;

Hits cast_on_two_threads(const char* kind, const Scene& scene, const Beams& beams) {
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})
      ->cast({.beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns}, hits);
  return hits;
}

Beams in_one_row(Beams beams) {
  beams.cols = static_cast<std::uint32_t>(beams.size());
  beams.rows = 1;
  return beams;
}

void expect_same_bits(const Hits& one, const Hits& other) {
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(same(one.range_m, other.range_m));
  EXPECT_TRUE(same(one.instance, other.instance));
  EXPECT_TRUE(same(one.primitive, other.primitive));
  EXPECT_TRUE(same(one.normal, other.normal));
  EXPECT_TRUE(same(one.cos_shading, other.cos_shading));
  EXPECT_TRUE(same(one.barycentrics, other.barycentrics));
  EXPECT_TRUE(same(one.reflectance, other.reflectance));
  EXPECT_TRUE(same(one.object_point_m, other.object_point_m));
}

std::ptrdiff_t count_hits(const Hits& hits, std::uint32_t instance) {
  return std::count(hits.instance.begin(), hits.instance.end(), instance);
}

/// Silhouettes, a second instance, missing beams, and a number of beams that fills no packet.
TEST(BeamLayout, HitsOfAGridEqualThoseOfOneRow) {
  Scene scene = builtin_scene("asteroid");
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_object.translation() = Eigen::Vector3d(0.4, 1.1, -0.2);
  Beams beams = camera_beams(57, 33, 40.0);
  beams.pinhole.reset();
  for (std::size_t i = 900; i < 920; ++i) {
    beams.directions[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  Beams with_origins = beams;
  Draws draws(3);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    with_origins.origins_m.emplace_back(0.01 * draws.direction());
  }
  for (const char* kind : {"auto", "rays"}) {
    for (const Beams& grid : {beams, with_origins}) {
      const Hits hits = cast_on_two_threads(kind, scene, grid);
      EXPECT_GT(count_hits(hits, 0), 200);
      EXPECT_GT(count_hits(hits, 1), 100);
      EXPECT_GT(count_hits(hits, kInvalidId), 200);
      expect_same_bits(hits, cast_on_two_threads(kind, scene, in_one_row(grid)));
    }
  }
}

/// All sixteen beams of a packet hit the same triangle, whose columns are written as a run.
TEST(BeamLayout, BeamsOnOneTriangleEqualSingleBeams) {
  const Scene scene = builtin_scene("box");
  Beams beams = camera_beams(48, 1, 400.0);
  beams.pinhole.reset();
  const Hits row = cast_on_two_threads("rays", scene, beams);
  EXPECT_EQ(count_hits(row, 0), 48);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    Beams one = beams;
    one.directions = {beams.directions[i]};
    one.cols = 1;
    const Hits hits = cast_on_two_threads("rays", scene, one);
    EXPECT_EQ(hits.range_m[0], row.range_m[i]);
    EXPECT_EQ(hits.primitive[0], row.primitive[i]);
    EXPECT_EQ(hits.normal[0], row.normal[i]);
    EXPECT_EQ(hits.cos_shading[0], row.cos_shading[i]);
  }
}

}  // namespace
}  // namespace glidar

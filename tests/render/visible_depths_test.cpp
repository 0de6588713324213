// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/visible_depths.hpp>
#include <render/renderer_suite.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

DepthSpan depths(const Scene& scene, const Beams& beams, const Pose& world_from_sensor) {
  const Instance& instance = scene.instances[0];
  const Mesh& mesh = scene.meshes[instance.mesh];
  ThreadPool thread_pool(2);
  VisibleDepths visible;
  return visible.of(view_of(instance, mesh, instance.world_from_object, world_from_sensor), mesh,
                    *beams.pinhole, thread_pool);
}

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

TEST(VisibleDepths, AreThoseOfTheVerticesIfAllAreInView) {
  const Scene scene = builtin_scene("box");  // half side 1
  const DepthSpan span = depths(scene, camera_beams(64, 64, 60.0), at(0.1, 0.2, -5.0));
  EXPECT_DOUBLE_EQ(span.nearest_m, 4.0);
  EXPECT_DOUBLE_EQ(span.farthest_m, 6.0);
}

TEST(VisibleDepths, AreClippedAtTheBordersOfTheView) {
  const Scene scene = builtin_scene("box");
  // A view of 45 degrees to each side from the middle: only the wall ahead is visible, and of the
  // side walls only their far edges.
  const DepthSpan wide = depths(scene, camera_beams(64, 64, 32.0), at(0.0, 0.0, 0.0));
  EXPECT_NEAR(wide.nearest_m, 1.0, 1e-15);
  EXPECT_NEAR(wide.farthest_m, 1.0, 1e-15);
  // Of 63.4 degrees: the side walls are visible from half the depth. All vertices are at -1 or 1.
  const DepthSpan wider = depths(scene, camera_beams(64, 64, 16.0), at(0.0, 0.0, 0.0));
  EXPECT_NEAR(wider.nearest_m, 0.5, 1e-15);
  EXPECT_NEAR(wider.farthest_m, 1.0, 1e-15);
}

TEST(VisibleDepths, AreEmptyForSurfacesBehindOrBeside) {
  const Scene scene = builtin_scene("box");
  for (const Pose& pose : {at(0.0, 0.0, 5.0), at(50.0, 0.0, -5.0)}) {
    const DepthSpan span = depths(scene, camera_beams(64, 64, 60.0), pose);
    EXPECT_GT(span.nearest_m, span.farthest_m);
  }
}

TEST(VisibleDepths, AreTightAroundTheHitsOnAnAsteroidThatFillsTheView) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(150, 100, 400.0);
  const Pose pose = look_at({1.6, 0.3, 0.2}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const DepthSpan span = depths(scene, beams, pose);
  Hits hits;
  make_renderer(scene, {})->cast(
      {.beams = beams, .world_from_sensor = pose, .hit_columns = {.depth = true}}, hits);
  double nearest = 1e9;
  for (const double depth : hits.depth_m) {
    if (std::isnan(depth)) continue;
    nearest = std::min(nearest, depth);
    EXPECT_LE(span.nearest_m, depth);
    EXPECT_GE(span.farthest_m, depth);
  }
  EXPECT_LT(nearest - span.nearest_m, 0.02);  // pixels do not hit the nearest point itself
}

}  // namespace
}  // namespace glidar

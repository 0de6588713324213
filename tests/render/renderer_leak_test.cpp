// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Closed meshes do not leak, in any renderer.
#include <glidar/render/resolver.hpp>
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <map>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::Draws;
using testing::loose_beams;

class RendererLeak : public testing::RendererSuite {};

/// A vertex or the middle of an edge, and the triangles around it.
struct Target {
  Eigen::Vector3d point;
  std::vector<std::uint32_t> around;
  bool on_border = false;  ///< of the mesh, where a beam may miss
};

std::vector<Target> targets_of(const Mesh& mesh) {
  std::vector<Target> targets(mesh.positions_m.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    targets[i].point = mesh.origin_m + mesh.positions_m[i].cast<double>();
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      targets[corners[k]].around.push_back(t);
      edges[std::minmax(corners[k], corners[(k + 1) % 3])].push_back(t);
    }
  }
  for (const auto& [ends, around] : edges) {
    const bool on_border = around.size() != 2;
    targets[ends.first].on_border |= on_border;
    targets[ends.second].on_border |= on_border;
    targets.push_back(
        {0.5 * (targets[ends.first].point + targets[ends.second].point), around, on_border});
  }
  return targets;
}

/// Casts one beam from outside at every target that is surrounded by front faces; counts the beams
/// that miss.
struct Aimed {
  std::size_t beams = 0;
  std::size_t leaked = 0;
};

Aimed aim_at(Renderer& renderer, const Scene& scene, const std::vector<Target>& targets,
             const std::vector<TrianglePlane>& planes, const Eigen::Vector3d& eye) {
  constexpr double kRim = 0.02;  // cosine: more grazing triangles count as the rim of what is seen
  const Mesh& mesh = scene.meshes[0];
  std::vector<bool> faces_eye(planes.size());
  for (std::size_t t = 0; t < planes.size(); ++t) {
    const Eigen::Vector3d way =
        mesh.origin_m + mesh.positions_m[mesh.triangles[t][0]].cast<double>() - eye;
    faces_eye[t] = planes[t].normal.dot(way) < -kRim * way.norm();
  }
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> ranges;
  for (const Target& target : targets) {
    if (target.on_border || target.around.empty()) continue;
    if (!std::all_of(target.around.begin(), target.around.end(),
                     [&](std::uint32_t t) { return faces_eye[t]; })) {
      continue;
    }
    directions.push_back((target.point - eye).normalized());
    ranges.push_back((target.point - eye).norm());
  }
  Pose pose = Pose::Identity();
  pose.translation() = eye;
  Hits hits;
  const Beams beams = loose_beams(directions, {});
  renderer.cast(
      {.beams = beams, .world_from_sensor = pose, .world_from_instance = {}, .hit_columns = {}},
      hits);
  const double tolerance = 1e-6 * bounds(scene).diagonal().norm();
  Aimed aimed{.beams = ranges.size(), .leaked = 0};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    // Something nearer may occlude the target; a miss is a leak.
    if (!(hits.range_m[i] <= ranges[i] + tolerance)) ++aimed.leaked;
  }
  return aimed;
}

/// Aims at all vertices and edge midpoints from many positions until a million beams are cast.
void expect_no_leak(Renderer& renderer, const Scene& scene) {
  const std::vector<Target> targets = targets_of(scene.meshes[0]);
  std::vector<TrianglePlane> planes;
  for (std::uint32_t i = 0; i < scene.meshes[0].triangles.size(); ++i) {
    planes.push_back(plane_of(scene.meshes[0], i));
  }
  const double size = bounds(scene).diagonal().norm();
  const Eigen::Vector3d middle = bounds(scene).center();
  Draws draws(11);
  Aimed all;
  for (int eye = 0; all.beams < 1'000'000; ++eye) {
    const Eigen::Vector3d axis = (eye < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(eye % 3);
    const Eigen::Vector3d from = eye < 6 ? axis : draws.direction();
    const Aimed aimed = aim_at(renderer, scene, targets, planes, middle + 1.5 * size * from);
    all.beams += aimed.beams;
    all.leaked += aimed.leaked;
    ASSERT_LT(eye, 1000) << "no target is visible";
  }
  EXPECT_EQ(all.leaked, 0U) << "of " << all.beams;
}

TEST_P(RendererLeak, AMillionBeamsAtVerticesAndEdgesOfASphereDoNotLeak) {
  const Scene scene = builtin_scene("sphere");
  expect_no_leak(*renderer(scene), scene);
}

TEST_P(RendererLeak, AMillionBeamsAtVerticesAndEdgesOfTheBunnyDoNotLeak) {
  GLIDAR_NEEDS_DATA();
  const Scene scene = testing::scene_of(testing::load_data_model("models/stanford/bun_zipper.ply"));
  expect_no_leak(*renderer(scene), scene);
}

INSTANTIATE_TEST_SUITE_P(All, RendererLeak, ::testing::Values("rays"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose parts have their own origins, in every renderer.
#include <glidar/core/error.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/io/model/model.hpp>
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace glidar {
namespace {

using testing::camera_beams;
using testing::RendererSuite;
using testing::turned;

using PiecesSuite = RendererSuite;

constexpr double kTolerance_m = 1e-7;

/// Boxes of this size, m, at these positions, which single precision cannot represent with one
/// origin.
constexpr double kSide_m = 0.7;
const std::vector<Eigen::Vector3d>& places_m() {
  static const std::vector<Eigen::Vector3d> places = {
      {100.1, 3.3, -0.7}, {-100.3, -2.9, 0.3}, {10000.7, -20.1, 0.3}, {-10000.9, 30.7, -0.3}};
  return places;
}

Mesh box_mesh() {
  return make_builtin_model("box:size=" + std::to_string(kSide_m)).mesh;
}

/// One mesh of all boxes.
Model far_boxes() {
  Model model = make_builtin_model("box");
  Mesh& all = model.mesh;
  const Mesh box = box_mesh();
  all = Mesh{};
  all.name = "boxes";
  for (const Eigen::Vector3d& place : places_m()) {
    const auto first = static_cast<std::uint32_t>(all.positions_m.size());
    all.origins.push_back({first, static_cast<std::uint32_t>(all.triangles.size()), place});
    all.positions_m.insert(all.positions_m.end(), box.positions_m.begin(), box.positions_m.end());
    all.normals.insert(all.normals.end(), box.normals.begin(), box.normals.end());
    for (const Triangle& t : box.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return model;
}

Scene scene_of_boxes() {
  Scene scene;
  add_model(scene, make_builtin_model("sphere"));
  add_model(scene, far_boxes());
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, -50.0);
  return scene;
}

/// Where a ray enters the upright box around a position: the slabs of Kay and Kajiya (1986).
double entry_m(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction,
               const Eigen::Vector3d& place) {
  const double half = double{static_cast<float>(0.5 * kSide_m)};
  double nearest = -INFINITY;
  double farthest = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (place[axis] - half - eye[axis]) / direction[axis];
    const double b = (place[axis] + half - eye[axis]) / direction[axis];
    nearest = std::max(nearest, std::min(a, b));
    farthest = std::min(farthest, std::max(a, b));
  }
  return nearest <= farthest ? nearest : std::nan("");
}

TEST_P(PiecesSuite, PartsFarFromEachOtherAreExact) {
  const Scene scene = scene_of_boxes();
  const Beams beams = camera_beams(24, 24, 30.0);
  for (std::size_t place = 0; place < places_m().size(); ++place) {
    const Eigen::Vector3d target = places_m()[place];
    const Pose pose = look_at(target + Eigen::Vector3d(1.1, -1.7, 0.9), target);
    const Hits hits = cast(scene, beams, pose);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (hits.instance[i] != 1U) continue;
      const double expected =
          entry_m(pose.translation(), pose.linear() * beams.directions[i], target);
      if (std::isnan(expected)) continue;  // beside the silhouette by less than a renderer's step
      ++compared;
      EXPECT_NEAR(hits.range_m[i], expected, kTolerance_m) << place << ", beam " << i;
      EXPECT_EQ(hits.primitive[i] / 12U, place);
      const Eigen::Vector3d world = pose * (hits.range_m[i] * beams.directions[i]);
      EXPECT_LT((hits.object_point_m[i] - world).norm(), kTolerance_m);
    }
    EXPECT_GT(compared, 100U) << place;
  }
}

TEST_P(PiecesSuite, EqualOneInstancePerPart) {
  const Scene scene = scene_of_boxes();
  Scene apart;
  add_model(apart, make_builtin_model("sphere"));
  apart.instances[0] = scene.instances[0];
  for (const Eigen::Vector3d& place : places_m()) {
    Model one = make_builtin_model("box");
    one.mesh = box_mesh();
    one.mesh.origin_m = place;
    add_model(apart, std::move(one));
  }
  const Beams beams = camera_beams(31, 23, 40.0);
  const Pose pose = look_at(places_m()[0] + Eigen::Vector3d(1.1, -1.7, 0.9), places_m()[0]);
  const Hits whole = cast(scene, beams, pose);
  const Hits parts = cast(apart, beams, pose);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    ASSERT_EQ(whole.instance[i] == kInvalidId, parts.instance[i] == kInvalidId) << i;
    if (whole.instance[i] == kInvalidId) continue;
    EXPECT_EQ(whole.instance[i], 1U);
    EXPECT_EQ(whole.primitive[i], 12U * (parts.instance[i] - 1U) + parts.primitive[i]);
    EXPECT_EQ(whole.range_m[i], parts.range_m[i]);
    EXPECT_EQ(whole.normal[i], parts.normal[i]);
    EXPECT_EQ(whole.shading_normal[i], parts.shading_normal[i]);
    EXPECT_EQ(whole.barycentrics[i], parts.barycentrics[i]);
  }
}

TEST_P(PiecesSuite, PosesEnabledInstancesAndBatchesReferToTheScene) {
  const Scene scene = scene_of_boxes();
  const Beams beams = camera_beams(20, 20, 30.0);
  const auto device = renderer(scene);
  const Pose moved = turned(0.3, {0.0, 0.2, 1.0}, {5.0, 6.0, 7.0});
  const Eigen::Vector3d target = moved * places_m()[1];
  const Pose pose = look_at(target + Eigen::Vector3d(2.0, 1.0, 1.0), target);
  const std::array<Pose, 2> poses = {scene.instances[0].world_from_object, moved};
  const std::array<std::uint8_t, 2> only_first = {1, 0};
  std::size_t report_count = 0;
  const auto count = [&report_count](BeamRange range) { report_count += range.end - range.begin; };
  const std::vector<CastRequest> requests = {
      {.beams = beams, .world_from_sensor = pose, .world_from_instance = poses},
      {.beams = beams,
       .world_from_sensor = pose,
       .world_from_instance = poses,
       .instance_enabled = only_first}};
  std::array<Hits, 2> batch;
  const std::array<Hits*, 2> into = {&batch[0], &batch[1]};
  device->cast_batch(requests, into);
  Hits one;
  CastRequest request = requests[0];
  if (GetParam() == "raster") request.on_tile_done = FunctionRef<void(BeamRange)>(count);
  device->cast(request, one);
  EXPECT_EQ(report_count, GetParam() == "raster" ? beams.size() : 0U);
  EXPECT_EQ(batch[0].instance, one.instance);
  EXPECT_EQ(batch[0].primitive, one.primitive);
  EXPECT_GT(std::count(one.instance.begin(), one.instance.end(), 1U), 20);
  EXPECT_EQ(std::count(batch[1].instance.begin(), batch[1].instance.end(), 1U), 0);
  const std::array<Pose, 3> too_many = {};
  EXPECT_THROW(device->cast({.beams = beams, .world_from_instance = too_many}, one), Error);
}

TEST_P(PiecesSuite, ATargetIncludesAllPieces) {
  const Scene scene = scene_of_boxes();
  const Pose pose = look_at(places_m()[0] + Eigen::Vector3d(2.0, 1.0, 1.0), places_m()[0]);
  Beams beams = camera_beams(20, 20, 40.0);
  const auto device = renderer(scene);
  std::vector<InstanceRange> targets(beams.size(), {1, 2});
  targets.front() = {0, 1};  // the sphere is not in view
  const CastRequest request{.beams = beams, .world_from_sensor = pose, .targets = targets};
  Hits hits;
  EXPECT_THROW(device->cast(request, hits), Error) << "targets for pixels";
  beams.pinhole.reset();
  if (GetParam() == "raster") {
    EXPECT_THROW(device->cast(request, hits), Error) << "no pinhole";
    return;
  }
  device->cast(request, hits);
  Hits all;
  make_renderer(scene, {.kind = "rays"})->cast({.beams = beams, .world_from_sensor = pose}, all);
  EXPECT_EQ(hits.instance.front(), kInvalidId);
  EXPECT_GT(std::count(hits.instance.begin(), hits.instance.end(), 1U), 50);
  for (std::size_t i = 1; i < beams.size(); ++i) {
    EXPECT_EQ(hits.instance[i], all.instance[i]);
    EXPECT_EQ(hits.primitive[i], all.primitive[i]);
  }
  targets.back() = {1, 3};
  EXPECT_THROW(device->cast(request, hits), Error) << "a target outside of the scene";
  targets.pop_back();
  EXPECT_THROW(device->cast(request, hits), Error) << "too few targets";
}

INSTANTIATE_TEST_SUITE_P(All, PiecesSuite, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar

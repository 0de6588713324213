// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Objects with different scales along their axes, in every renderer.
#include <glidar/io/model/model.hpp>
#include <render/renderer_suite.hpp>

namespace glidar {
namespace {

using testing::camera_beams;
using testing::RendererSuite;
using testing::turned;

class StretchedSuite : public RendererSuite {
 protected:
  void expect_ellipsoid(const Eigen::Vector3d& axes_m);
};

void StretchedSuite::expect_ellipsoid(const Eigen::Vector3d& axes_m) {
  Scene scene = testing::builtin_scene("sphere");
  set_scale(scene, 0, axes_m);
  scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.4, -0.2, 6.0});
  const Beams beams = camera_beams(48, 40, 50.0);
  const Hits hits = cast(scene, beams, Pose::Identity());
  const Pose object_from_world = scene.instances[0].world_from_object.inverse();
  const testing::BruteForce brute_force(scene);
  std::size_t on_object = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    ++on_object;
    const testing::Judged truth = brute_force.judge(Eigen::Vector3d::Zero(), beams.directions[i]);
    constexpr double kBorder_m = 0.01;  // nearer to an edge the renderer may report the neighbour
    if (truth.border_m > kBorder_m) {
      EXPECT_EQ(hits.primitive[i], truth.primitive) << i;
      EXPECT_NEAR(hits.range_m[i], truth.range_m, 1e-11) << i;
    }
    const Eigen::Vector3d point = object_from_world * (hits.range_m[i] * beams.directions[i]);
    EXPECT_LT((axes_m.cwiseProduct(hits.object_point_m[i]) - point).norm(), 1e-9) << i;
    // of x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 the gradient is (x/a^2, y/b^2, z/c^2)
    const Eigen::Vector3d gradient = point.cwiseQuotient(axes_m.cwiseProduct(axes_m));
    const Eigen::Vector3d smooth =
        object_from_world.linear() * hits.shading_normal[i].cast<double>();
    EXPECT_LT((smooth - gradient.normalized()).norm(), 0.05) << i;  // facets are 0.1 rad wide
  }
  EXPECT_GT(on_object, beams.size() / 20);
}

TEST_P(StretchedSuite, HitsAndNormalsAreThoseOfTheEllipsoid) {
  expect_ellipsoid({2.0, 0.5, 1.25});
}

TEST_P(StretchedSuite, HitsAndNormalsOfAMirroredObjectAreThoseOfTheEllipsoid) {
  expect_ellipsoid({2.0, -0.5, 1.25});
}

INSTANTIATE_TEST_SUITE_P(All, StretchedSuite, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The tree over instances finds the same instances as a test of each.
#include <glidar/render/hit_writer.hpp>
#include <render/renderer_suite.hpp>

#include <set>

namespace glidar {
namespace {

using testing::Draws;
using Box = InstanceTree::Box;

/// Boxes of many sizes around the origin, and the tree over the enabled ones.
class Stage {
 public:
  Scene scene = testing::builtin_scene("box");
  std::vector<std::uint8_t> present;
  Beams beams;
  std::vector<Box> mesh_boxes;
  std::unique_ptr<Resolver> resolver;
  InstanceTree tree;
  std::vector<Box> boxes;  ///< of the instances' corners in the tree's frame

  Stage(std::size_t count, std::uint64_t seed) {
    Draws draws(seed);
    const Instance one = scene.instances[0];
    scene.instances.clear();
    for (std::size_t i = 0; i < count; ++i) {
      Instance instance = one;
      instance.scale = std::pow(10.0, -1.0 + 1.5 * draws.next());
      const Eigen::Vector3d place =
          20.0 * Eigen::Vector3d(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5);
      instance.world_from_object = testing::turned(6.0 * draws.next(), draws.direction(), place);
      scene.instances.push_back(instance);
      present.push_back(draws.next() < 0.9 ? 1 : 0);
    }
    for (const Mesh& mesh : scene.meshes) {
      Box& box = mesh_boxes.emplace_back();
      for (const Eigen::Vector3f& p : mesh.positions_m) box.extend(p.cast<double>());
    }
    resolver = std::make_unique<Resolver>(scene);
    const CastRequest request{
        .beams = beams,
        .world_from_sensor = testing::turned(1.0, {0.3, 0.2, 1.0}, {1.0, -2.0, 3.0}),
        .instance_enabled = present};
    resolver->set_poses(request.world_from_sensor, {});
    tree.build(request, *resolver, mesh_boxes);
    for (std::uint32_t i = 0; i < count; ++i) boxes.push_back(box(i));
  }

 private:
  [[nodiscard]] Box box(std::uint32_t i) const {
    Box around;
    for (const Eigen::Vector3f& p : scene.meshes[0].positions_m) {
      const Eigen::Vector3d corner =
          sensor_from_object(resolver->view(i)) * p.cast<double>().homogeneous();
      around.extend(tree.tree_from_sensor() * corner);
    }
    return around;
  }
};

Box grown(const Box& box, double by) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(by);
  return {box.min() - margin, box.max() + margin};
}

constexpr double kRoom_m = 1e-3;  // above what the tree adds to boxes at 30 m

TEST(InstanceTree, FindsTheInstancesAroundAPoint) {
  for (const std::size_t count : {1U, 2U, 8U, 9U, 65U, 600U}) {
    const Stage stage(count, count);
    Draws draws(count);
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d point =
          20.0 * Eigen::Vector3d(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5);
      std::set<std::uint32_t> found;
      stage.tree.visit_near({point, point},
                            [&](std::uint32_t i) { return found.insert(i).second; });
      for (std::uint32_t i = 0; i < count; ++i) {
        const bool is_there = stage.present[i] != 0;
        if (is_there && stage.boxes[i].contains(point)) {
          EXPECT_EQ(found.count(i), 1U) << i;
        } else if (!is_there || !grown(stage.boxes[i], kRoom_m).contains(point)) {
          EXPECT_EQ(found.count(i), 0U) << i;
        }
      }
    }
  }
}

TEST(InstanceTree, EndsASearchIfTheVisitorReturnsFalse) {
  const Stage stage(100, 5);
  int visited = 0;
  stage.tree.visit_near({Eigen::Vector3d::Constant(-99.0), Eigen::Vector3d::Constant(99.0)},
                        [&](std::uint32_t) { return ++visited < 7; });
  EXPECT_EQ(visited, 7);
}

TEST(InstanceTree, ReportsWhereBoxesOverlap) {
  const Stage stage(120, 6);
  std::size_t alone = 0;
  for (std::uint32_t i = 0; i < stage.present.size(); ++i) {
    if (stage.present[i] == 0) continue;
    Box shared;
    for (std::uint32_t k = 0; k < stage.present.size(); ++k) {
      if (k == i || stage.present[k] == 0 || !stage.boxes[k].intersects(stage.boxes[i])) continue;
      shared.extend(stage.boxes[k].intersection(stage.boxes[i]));
    }
    if (shared.isEmpty()) {
      ++alone;
    } else {
      EXPECT_TRUE(grown(stage.tree.shared(i), 1e-12).contains(shared)) << i;
      EXPECT_TRUE(grown(shared, kRoom_m).contains(stage.tree.shared(i))) << i;
    }
  }
  EXPECT_TRUE(stage.tree.has_overlaps());
  EXPECT_GT(alone, 0U);
  EXPECT_LT(alone, 100U);
  EXPECT_FALSE(Stage(1, 1).tree.has_overlaps());
}

}  // namespace
}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/box_tree.hpp>

#include <render/renderer_suite.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glidar::rays {
namespace {

using glidar::testing::Draws;

constexpr std::uint32_t kBoxes = 200;

/// A cube of one metre around a point.
BoxReference cube_at(const Eigen::Vector3d& middle, std::uint32_t index) {
  BoxReference box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = static_cast<float>(middle[axis]) - 0.5F;
    box.high[axis] = static_cast<float>(middle[axis]) + 0.5F;
  }
  box.index = index;
  return box;
}

class BoxTreeTest : public ::testing::Test {
 protected:
  void build() {
    std::vector<BoxReference> sorted = boxes;
    tree.build(sorted, kBoxes, thread_pool);
  }

  /// The index of every leaf, each of which has its box, and each node's box is the one around its
  /// children.
  std::vector<std::uint32_t> leaves_below(std::uint32_t index) {
    std::vector<std::uint32_t> found;
    const TreeNode& node = tree.nodes()[index];
    for (unsigned i = 0; i < 8; ++i) {
      if (node.child[i] == kNoChild) continue;
      if (node.child[i] >= 0) {
        const auto child = static_cast<std::uint32_t>(node.child[i]);
        const TreeNode& below = tree.nodes()[child];
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(node.low[axis][i], *std::min_element(below.low[axis], below.low[axis] + 8));
          EXPECT_EQ(node.high[axis][i], *std::max_element(below.high[axis], below.high[axis] + 8));
        }
        const std::vector<std::uint32_t> inner = leaves_below(child);
        found.insert(found.end(), inner.begin(), inner.end());
        continue;
      }
      const std::uint32_t box = tree.index_in(static_cast<std::uint32_t>(~node.child[i]));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(node.low[axis][i], boxes[box].low[axis]);
        EXPECT_EQ(node.high[axis][i], boxes[box].high[axis]);
      }
      found.push_back(box);
    }
    return found;
  }

  void expect_fits() {
    std::vector<std::uint32_t> found = leaves_below(0);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), boxes.size());
    for (std::uint32_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], boxes[i].index);
    for (const BoxReference& box : boxes) {
      double squared = 0.0;  // of the farthest corner
      for (int axis = 0; axis < 3; ++axis) {
        const double centre = tree.sphere().centre[axis];
        const double reach =
            std::max(std::abs(box.low[axis] - centre), std::abs(box.high[axis] - centre));
        squared += reach * reach;
      }
      EXPECT_LE(std::sqrt(squared), tree.sphere().radius);
    }
  }

  void move(std::uint32_t index, const Eigen::Vector3d& to) {
    boxes[index] = cube_at(to, index);
    tree.move(boxes[index]);
  }

  ThreadPool thread_pool{2};
  BoxTree tree;
  std::vector<BoxReference> boxes;
};

TEST_F(BoxTreeTest, RefitsMovedBoxes) {
  Draws draws(1);
  for (std::uint32_t i = 0; i < kBoxes; ++i) {
    boxes.push_back(cube_at(30.0 * draws.next() * draws.direction(), i));
  }
  build();
  expect_fits();
  for (std::uint32_t step = 0; step < 50; ++step) {
    move(7 * step % kBoxes, 40.0 * draws.next() * draws.direction());
    expect_fits();
  }
}

TEST_F(BoxTreeTest, NeedsRebuildWhenBoxesHaveMovedFar) {
  for (std::uint32_t i = 0; i < kBoxes; ++i) boxes.push_back(cube_at({3.0 * i, 0.0, 0.0}, i));
  build();
  EXPECT_FALSE(tree.needs_rebuild());
  move(0, {1.0, 0.0, 0.0});
  EXPECT_FALSE(tree.needs_rebuild());
  move(0, {0.0, 1e4, 0.0});
  EXPECT_TRUE(tree.needs_rebuild());
  move(0, {1.0, 0.0, 0.0});
  EXPECT_FALSE(tree.needs_rebuild());
}

TEST_F(BoxTreeTest, AcceptsASingleBox) {
  boxes = {cube_at({1.0, 2.0, 3.0}, 5)};
  tree.build(boxes, 6, thread_pool);
  boxes[0] = cube_at({-100.0, 2.0, 3.0}, 5);
  tree.move(boxes[0]);
  EXPECT_EQ(tree.index_in(0), 5U);
  EXPECT_EQ(tree.nodes()[0].low[0][0], -100.5F);
  EXPECT_EQ(tree.sphere().centre[0], -100.0);
}

}  // namespace
}  // namespace glidar::rays

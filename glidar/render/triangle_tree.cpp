// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/triangle_tree.hpp>

#include <glidar/render/draw_order.hpp>

#include <algorithm>

namespace glidar {

TriangleTree::TriangleTree(const Mesh& mesh) : triangles_(draw_order(mesh, {}).drawn) {
  if (triangles_.empty()) return;
  std::vector<Box>& leaves = levels_.emplace_back();
  leaves.reserve(triangles_.size());
  for (const std::uint32_t triangle : triangles_) {
    const Triangle& t = mesh.triangles[triangle];
    const Eigen::Vector3f& a = mesh.positions_m[t[0]];
    const Eigen::Vector3f& b = mesh.positions_m[t[1]];
    const Eigen::Vector3f& c = mesh.positions_m[t[2]];
    leaves.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
  }
  while (levels_.back().size() > 1) {
    std::vector<Box> next;
    const std::vector<Box>& below = levels_.back();
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % kFan == 0) next.push_back(below[i]);
      next.back().min = next.back().min.cwiseMin(below[i].min);
      next.back().max = next.back().max.cwiseMax(below[i].max);
    }
    levels_.push_back(std::move(next));
  }
  const Box& root = levels_.back().front();
  box_ = Eigen::AlignedBox3d(root.min.cast<double>(), root.max.cast<double>());
  reach_ = box_.min().cwiseAbs().cwiseMax(box_.max().cwiseAbs()).norm();
}

/// By slabs: T. L. Kay and J. T. Kajiya, "Ray tracing complex scenes" (1986).
bool TriangleTree::meets(const ObjectRay& ray, double margin, double most, const Box& box) {
  double enter = 0.0;
  double leave = most;
  for (int k = 0; k < 3; ++k) {
    const double low = static_cast<double>(box.min[k]) - margin - ray.origin[k];
    const double high = static_cast<double>(box.max[k]) + margin - ray.origin[k];
    if (ray.direction[k] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double first = low / ray.direction[k];
    const double second = high / ray.direction[k];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  // A margin more for the rounding of these distances.
  return enter <= leave + margin;
}

}  // namespace glidar

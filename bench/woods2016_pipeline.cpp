// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "woods2016_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace glidar::bench {

KdTree::KdTree(std::vector<Eigen::Vector3f> points) : points_(std::move(points)) {
  build(0, points_.size(), 0);
}

void KdTree::build(std::size_t begin, std::size_t end, int axis) {
  if (end - begin < 2) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(
      at(begin), at(middle), at(end),
      [axis](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a[axis] < b[axis]; });
  build(begin, middle, (axis + 1) % 3);
  build(middle + 1, end, (axis + 1) % 3);
}

void KdTree::search(std::size_t begin, std::size_t end, const Eigen::Vector3f& to, int axis,
                    Best& best) const {
  if (begin >= end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const float squared = (points_[middle] - to).squaredNorm();
  if (squared < best.squared) best = {middle, squared};
  const float beyond = to[axis] - points_[middle][axis];
  const std::pair<std::size_t, std::size_t> lower = {begin, middle};
  const std::pair<std::size_t, std::size_t> upper = {middle + 1, end};
  const auto& [near_side, far_side] =
      beyond < 0.0F ? std::pair{lower, upper} : std::pair{upper, lower};
  search(near_side.first, near_side.second, to, (axis + 1) % 3, best);
  if (beyond * beyond >= best.squared) return;
  search(far_side.first, far_side.second, to, (axis + 1) % 3, best);
}

Eigen::Vector3f KdTree::nearest(const Eigen::Vector3f& to) const {
  Best best{0, std::numeric_limits<float>::infinity()};
  search(0, points_.size(), to, 0, best);
  return points_[best.point];
}

Woods2016Pipeline::Woods2016Pipeline(const Model* model, std::uint32_t side)
    : model_(*model),
      side_(side),
      picture_(*model, kRawFramebuffer, side),
      tree_(model->scene.meshes[0].positions_m) {}

void Woods2016Pipeline::measure() {
  set_planes();
  picture_.draw_and_read();
  unproject();
}

void Woods2016Pipeline::set_planes() {
  const Eigen::Vector3f eye = model_.world_from_sensor.translation().cast<float>();
  const Eigen::Vector3f middle = bounds(model_.scene).center().cast<float>();
  const Eigen::Vector3f ahead = model_.world_from_sensor.linear().col(2).cast<float>();
  const Eigen::Vector3f nearest = tree_.nearest(eye);
  const Eigen::Vector3f farthest = tree_.nearest(2.0F * middle - eye);  // beside the mirrored eye
  near_m_ = 0.99F * ahead.dot(nearest - eye);
  far_m_ = 1.01F * ahead.dot(farthest - eye);
  picture_.set_planes(near_m_, far_m_);
}

void Woods2016Pipeline::unproject() {
  const std::vector<std::uint32_t>& pixels = picture_.pixels();
  const float metres_per_step = (far_m_ - near_m_) / 65536.0F;
  const float slope =
      2.0F * static_cast<float>(std::tan(kFov_rad / 2.0)) / static_cast<float>(side_);
  const float centre = 0.5F * static_cast<float>(side_) - 0.5F;
  cloud_.clear();
  for (std::uint32_t row = 0; row < side_; ++row) {
    const float y = slope * (centre - static_cast<float>(row));
    for (std::uint32_t col = 0; col < side_; ++col) {
      const std::uint32_t rgba = pixels[std::size_t{row} * side_ + col];
      if (rgba >> 24U == 0) continue;
      const float steps = static_cast<float>((rgba >> 8U & 255U) * 256U + (rgba >> 16U & 255U));
      const float depth_m = near_m_ + steps * metres_per_step;
      const float x = slope * (centre - static_cast<float>(col));
      cloud_.emplace_back(x * depth_m, y * depth_m, depth_m,
                          static_cast<float>(rgba & 255U) / 255.0F);
    }
  }
}

}  // namespace glidar::bench

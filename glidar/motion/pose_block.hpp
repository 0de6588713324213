// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar {

/// Poses component by component, for loops over all of them.
struct PoseBlock {
  static constexpr std::size_t kSize = 64;
  using Component = std::array<double, kSize>;

  alignas(64) std::array<Component, 9> rotation;  ///< column by column
  std::array<Component, 3> position_m;

  void set(std::size_t i, const Pose& pose) {
    for (int k = 0; k < 9; ++k) {
      rotation[static_cast<std::size_t>(k)][i] = pose.linear()(k % 3, k / 3);
    }
    for (int k = 0; k < 3; ++k) {
      position_m[static_cast<std::size_t>(k)][i] = pose.translation()[k];
    }
  }

  [[nodiscard]] Eigen::Matrix3d rotation_at(std::size_t i) const {
    Eigen::Matrix3d matrix;
    for (std::size_t k = 0; k < 9; ++k) matrix.data()[k] = rotation[k][i];
    return matrix;
  }

  [[nodiscard]] Eigen::Vector3d position_at(std::size_t i) const {
    return {position_m[0][i], position_m[1][i], position_m[2][i]};
  }
};

/// The poses at up to PoseBlock::kSize times, identical to pose_at() for each. Of timed poses,
/// fastest if times that follow each other are between the same two.
void poses_at(const Trajectory& trajectory, std::span<const std::int64_t> t_ns, PoseBlock& out);

}  // namespace glidar

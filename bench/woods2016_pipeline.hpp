// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "raw_opengl.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace glidar::bench {

/// Finds nearest points: J. L. Bentley, "Multidimensional binary search trees used for associative
/// searching" (1975).
class KdTree {
 public:
  explicit KdTree(std::vector<Eigen::Vector3f> points);

  [[nodiscard]] Eigen::Vector3f nearest(const Eigen::Vector3f& to) const;

 private:
  struct Best {
    std::size_t point;
    float squared;
  };
  void build(std::size_t begin, std::size_t end, int axis);
  void search(std::size_t begin, std::size_t end, const Eigen::Vector3f& to, int axis,
              Best& best) const;

  std::vector<Eigen::Vector3f> points_;  ///< each splits its section in the middle
};

/// The original GLIDAR's method (Woods and Christian, 2016), for its speed: planes from the nearest
/// and the farthest vertex, found in a tree every frame; intensity and two bytes of depth drawn
/// into RGBA, read back at once; every pixel unprojected, the background removed. Its errors that
/// do not affect speed are not reproduced.
class Woods2016Pipeline {
 public:
  Woods2016Pipeline(const Model* model, std::uint32_t side);

  /// One point cloud.
  void measure();

  /// x, y, z (x left, y up, z forward) and intensity of every point of the last cloud.
  [[nodiscard]] const std::vector<Eigen::Vector4f>& cloud() const { return cloud_; }

 private:
  void set_planes();
  void unproject();

  const Model& model_;
  std::uint32_t side_;
  RawOpengl picture_;
  KdTree tree_;
  float near_m_ = 0.0F;
  float far_m_ = 0.0F;
  std::vector<Eigen::Vector4f> cloud_;
};

}  // namespace glidar::bench

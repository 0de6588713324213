// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/stereo.hpp>

#include <vector>

namespace glidar::testing {

/// Costs by their definition, one number at a time, for comparison: [row][column][disparity].
class BruteForce {
 public:
  BruteForce(const GreyImage& left, const GreyImage& right, const StereoOptions& options);

  /// Hamming distances summed over the box.
  [[nodiscard]] int matching_cost(int x, int y, int d) const { return cost_[index(x, y, d)]; }
  /// Sums over all paths.
  [[nodiscard]] int summed_cost(int x, int y, int d) const { return sum_[index(x, y, d)]; }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int d) const {
    return static_cast<std::size_t>((y * width_ + x) * count_ + d);
  }
  [[nodiscard]] int hamming(const GreyImage& left, const GreyImage& right, int x, int y,
                            int d) const;
  void sum_boxes(const GreyImage& left, const GreyImage& right);
  /// min(L(q, d), L(q, d - 1) + P1, L(q, d + 1) + P1, m + P2) - m of the pixel q = (u, v) before
  [[nodiscard]] int path_step(const std::vector<int>& path, int u, int v, int d) const;
  void add_path(int dx, int dy);
  /// Calls body(x, y, d) for all, row by row.
  template <class Body>
  void for_cells(const Body& body) const {
    for (int y = 0; y < height_; ++y) {
      for (int i = 0; i < width_ * count_; ++i) body(i / count_, y, i % count_);
    }
  }

  StereoOptions options_;
  int width_;
  int height_;
  int count_;
  std::vector<int> cost_;
  std::vector<int> sum_;
};

}  // namespace glidar::testing

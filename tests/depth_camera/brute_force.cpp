// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/brute_force.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::testing {

namespace {

int level_at(const GreyImage& image, int x, int y) {
  const int column = std::clamp<int>(x, 0, static_cast<int>(image.width) - 1);
  const int row = std::clamp<int>(y, 0, static_cast<int>(image.height) - 1);
  return image
      .level[static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column)];
}

/// The census of one pixel as a list of booleans.
std::vector<bool> census_at(const GreyImage& image, StereoCensus kind, int x, int y) {
  std::vector<bool> bits;
  const int r = kind == StereoCensus::window_9x9 ? 4 : 3;
  const int size = 2 * r + 1;
  const bool is_symmetric = kind == StereoCensus::symmetric_7x7;
  for (int i = 0; i < (is_symmetric ? size * size / 2 : size * size); ++i) {
    const int dx = i % size - r;
    const int dy = i / size - r;
    if (dx == 0 && dy == 0) continue;
    const int other = is_symmetric ? level_at(image, x - dx, y - dy) : level_at(image, x, y);
    bits.push_back(level_at(image, x + dx, y + dy) < other);
  }
  return bits;
}

}  // namespace

BruteForce::BruteForce(const GreyImage& left, const GreyImage& right, const StereoOptions& options)
    : options_(options),
      width_(static_cast<int>(left.width)),
      height_(static_cast<int>(left.height)),
      count_(static_cast<int>(options.disparities)),
      cost_(static_cast<std::size_t>(width_ * height_ * count_)),
      sum_(cost_.size()) {
  sum_boxes(left, right);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      if (options.paths == 8 || dx == 0 || dy == 0) add_path(dx, dy);
    }
  }
}

int BruteForce::hamming(const GreyImage& left, const GreyImage& right, int x, int y, int d) const {
  const int other = x - static_cast<int>(options_.min_disparity_px) - d;
  const std::vector<bool> a = census_at(left, options_.census, x, y);
  if (other < 0) return static_cast<int>(a.size()) / 2;  // what a random pixel would differ in
  const std::vector<bool> b = census_at(right, options_.census, other, y);
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

void BruteForce::sum_boxes(const GreyImage& left, const GreyImage& right) {
  std::vector<int> distances(cost_.size());
  for_cells(
      [&](int x, int y, int d) { distances[index(x, y, d)] = hamming(left, right, x, y, d); });
  const int side = static_cast<int>(options_.box_px);
  for_cells([&](int x, int y, int d) {
    for (int i = 0; i < side * side; ++i) {
      const int u = std::clamp(x + i % side - side / 2, 0, width_ - 1);
      const int v = std::clamp(y + i / side - side / 2, 0, height_ - 1);
      cost_[index(x, y, d)] += distances[index(u, v, d)];
    }
  });
}

int BruteForce::path_step(const std::vector<int>& path, int u, int v, int d) const {
  const int area = static_cast<int>(options_.box_px * options_.box_px);
  const int p1 = static_cast<int>(std::lround(options_.p1 * area));
  const int p2 = static_cast<int>(std::lround(options_.p2 * area));
  const auto first = path.begin() + static_cast<std::ptrdiff_t>(index(u, v, 0));
  const int least = *std::min_element(first, first + count_);
  int cost = std::min(first[d], least + p2);
  if (d > 0) cost = std::min(cost, first[d - 1] + p1);
  if (d + 1 < count_) cost = std::min(cost, first[d + 1] + p1);
  return cost - least;
}

void BruteForce::add_path(int dx, int dy) {
  std::vector<int> path(cost_.size());
  for_cells([&](int i, int j, int d) {
    const int x = dx < 0 ? width_ - 1 - i : i;
    const int y = dy < 0 ? height_ - 1 - j : j;
    const int u = x - dx;
    const int v = y - dy;
    const bool is_start = u < 0 || u >= width_ || v < 0 || v >= height_;
    const int cost = cost_[index(x, y, d)] + (is_start ? 0 : path_step(path, u, v, d));
    path[index(x, y, d)] = cost;
    sum_[index(x, y, d)] += cost;
  });
}

}  // namespace glidar::testing

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/neighbours.hpp>

#include <algorithm>
#include <numeric>

namespace glidar {
namespace {

bool is_before(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Numbers the positions; returns how many differ.
std::uint32_t number_positions(const std::vector<Eigen::Vector3f>& positions,
                               std::vector<std::uint32_t>& place) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return is_before(positions[a], positions[b]);
  });
  place.resize(positions.size());
  std::uint32_t places = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || positions[order[i]] != positions[order[i - 1]]) ++places;
    place[order[i]] = places - 1;
  }
  return places;
}

}  // namespace

Neighbours::Neighbours(const Mesh& mesh) {
  const std::uint32_t places = number_positions(mesh.positions_m, place_);
  first_.assign(places + 2, 0);  // shifted by one while the triangles are filled in
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) ++first_[place_[vertex] + 2];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  triangles_.resize(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      triangles_[first_[place_[vertex] + 1]++] = t;
    }
  }
  first_.pop_back();
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/draw_order.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>

namespace glidar {
namespace {

constexpr int kBits = 16;  // of a place, along each axis
constexpr float kOrderSteps = (1U << kBits) - 1;
constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// Two zeros before every bit.
std::uint64_t spread(std::uint64_t bits) {
  std::uint64_t result = 0;
  for (int i = 0; i < kBits; ++i) result |= (bits >> i & 1U) << (3 * i);
  return result;
}

/// Places in a box along G. M. Morton's curve ("A computer oriented geodetic data base", 1966).
class Curve {
 public:
  explicit Curve(const Mesh& mesh) {
    for (const Eigen::Vector3f& p : mesh.positions_m) box_.extend(p);
    const float size = box_.isEmpty() ? 0.0F : box_.sizes().maxCoeff();
    steps_per_metre_ = size > 0.0F ? kOrderSteps / size : 0.0F;
  }

  [[nodiscard]] std::uint64_t at(const Eigen::Vector3f& position) const {
    const Eigen::Vector3f step = steps_per_metre_ * (position - box_.min());
    std::uint64_t place = 0;
    for (int axis = 0; axis < 3; ++axis) {
      place |= spread(static_cast<std::uint64_t>(std::min(std::max(0.0F, step[axis]), kOrderSteps)))
               << axis;
    }
    return place;
  }

 private:
  Eigen::AlignedBox3f box_;
  float steps_per_metre_;
};

struct Key {
  std::uint32_t kind;
  std::uint64_t place;
  std::uint32_t triangle;

  [[nodiscard]] bool operator<(const Key& other) const {
    return std::tie(kind, place, triangle) < std::tie(other.kind, other.place, other.triangle);
  }
};

std::vector<Key> sorted_keys(const Mesh& mesh, const std::vector<std::uint32_t>& kinds) {
  const Curve curve(mesh);
  std::vector<Key> keys;
  keys.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    // Divided first: the sum of large ones would overflow.
    constexpr float kThird = 1.0F / 3.0F;
    const Eigen::Vector3f middle = kThird * mesh.positions_m[t[0]] +
                                   kThird * mesh.positions_m[t[1]] +
                                   kThird * mesh.positions_m[t[2]];
    keys.push_back({kinds.empty() ? 0 : kinds[i], curve.at(middle), i});
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Adds a triangle and those of its corners that are not there yet; `place_of` tells where each
/// vertex of the mesh stands.
void add(const Mesh& mesh, const Key& key, std::vector<std::uint32_t>& place_of, DrawOrder& order) {
  const auto next = static_cast<std::uint32_t>(order.drawn.size());
  if (next == 0 || key.kind != order.ranges.back().kind)
    order.ranges.push_back({next, 0, key.kind});
  ++order.ranges.back().count;
  order.drawn.push_back(key.triangle);
  Triangle corners = mesh.triangles[key.triangle];
  for (std::uint32_t& corner : corners) {
    if (place_of[corner] == kNowhere) {
      place_of[corner] = static_cast<std::uint32_t>(order.vertices.size());
      order.vertices.push_back(corner);
    }
    corner = place_of[corner];
  }
  order.triangles.push_back(corners);
}

}  // namespace

DrawOrder draw_order(const Mesh& mesh, const std::vector<std::uint32_t>& kinds) {
  DrawOrder order;
  order.drawn.reserve(mesh.triangles.size());
  order.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> place_of(mesh.positions_m.size(), kNowhere);
  for (const Key& key : sorted_keys(mesh, kinds)) add(mesh, key, place_of, order);
  return order;
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/draw_order.hpp>

#include <glidar/render/morton.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>

namespace glidar {
namespace {

constexpr float kOrderSteps = (1U << kMortonBits) - 1;
constexpr std::uint32_t kUnassigned = std::numeric_limits<std::uint32_t>::max();

/// Morton codes of positions in the box around a mesh.
class MortonCurve {
 public:
  explicit MortonCurve(const Mesh& mesh) {
    for (const Eigen::Vector3f& p : mesh.positions_m) box_.extend(p);
    const float size = box_.isEmpty() ? 0.0F : box_.sizes().maxCoeff();
    steps_per_metre_ = size > 0.0F ? kOrderSteps / size : 0.0F;
  }

  [[nodiscard]] std::uint64_t at(const Eigen::Vector3f& position) const {
    const Eigen::Vector3f step = steps_per_metre_ * (position - box_.min());
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      code |=
          expand_bits(static_cast<std::uint64_t>(std::min(std::max(0.0F, step[axis]), kOrderSteps)))
          << axis;
    }
    return code;
  }

 private:
  Eigen::AlignedBox3f box_;
  float steps_per_metre_;
};

struct Key {
  std::uint32_t kind;
  std::uint64_t code;
  std::uint32_t triangle;

  [[nodiscard]] bool operator<(const Key& other) const {
    return std::tie(kind, code, triangle) < std::tie(other.kind, other.code, other.triangle);
  }
};

std::vector<Key> sorted_keys(const Mesh& mesh, const std::vector<std::uint32_t>& kinds) {
  const MortonCurve curve(mesh);
  std::vector<Key> keys;
  keys.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    // Divided first, because the sum of large coordinates would overflow.
    constexpr float kThird = 1.0F / 3.0F;
    const Eigen::Vector3f middle = kThird * mesh.positions_m[t[0]] +
                                   kThird * mesh.positions_m[t[1]] +
                                   kThird * mesh.positions_m[t[2]];
    keys.push_back({kinds.empty() ? 0 : kinds[i], curve.at(middle), i});
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Adds a triangle and those of its corners that are missing; `new_index` has the new index of each
/// vertex of the mesh.
void add(const Mesh& mesh, const Key& key, std::vector<std::uint32_t>& new_index,
         DrawOrder& order) {
  const auto next = static_cast<std::uint32_t>(order.drawn.size());
  if (next == 0 || key.kind != order.ranges.back().kind)
    order.ranges.push_back({next, 0, key.kind});
  ++order.ranges.back().count;
  order.drawn.push_back(key.triangle);
  Triangle corners = mesh.triangles[key.triangle];
  for (std::uint32_t& corner : corners) {
    if (new_index[corner] == kUnassigned) {
      new_index[corner] = static_cast<std::uint32_t>(order.vertices.size());
      order.vertices.push_back(corner);
    }
    corner = new_index[corner];
  }
  order.triangles.push_back(corners);
}

}  // namespace

DrawOrder draw_order(const Mesh& mesh, const std::vector<std::uint32_t>& kinds) {
  DrawOrder order;
  order.drawn.reserve(mesh.triangles.size());
  order.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> new_index(mesh.positions_m.size(), kUnassigned);
  for (const Key& key : sorted_keys(mesh, kinds)) add(mesh, key, new_index, order);
  return order;
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/resolver.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace glidar {
namespace {

/// Hash of a position's bits (finaliser of SplitMix64); -0 counts as 0.
std::uint64_t position_hash(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) {
    hash += std::bit_cast<std::uint32_t>(p[k] + 0.0F) + 0x9e3779b97f4a7c15U;
    hash = (hash ^ (hash >> 30U)) * 0xbf58476d1ce4e5b9U;
    hash = (hash ^ (hash >> 27U)) * 0x94d049bb133111ebU;
    hash ^= hash >> 31U;
  }
  return hash;
}

/// The corners' positions, sorted.
std::array<std::array<float, 3>, 3> sorted_corners(const Mesh& mesh, std::uint32_t triangle) {
  std::array<std::array<float, 3>, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3f& p = mesh.positions_m[mesh.triangles[triangle][k]];
    corners[k] = {p.x(), p.y(), p.z()};
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

struct CornerKey {
  std::uint64_t hash;
  std::uint32_t triangle;
};

/// Triangles by a hash of their corners that does not depend on the corners' order, then by index.
std::vector<CornerKey> sorted_keys(const Mesh& mesh) {
  std::vector<std::uint64_t> vertex_hash(mesh.positions_m.size());
  std::transform(mesh.positions_m.begin(), mesh.positions_m.end(), vertex_hash.begin(),
                 position_hash);
  std::vector<CornerKey> keys(mesh.triangles.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    keys[i] = {vertex_hash[t[0]] + vertex_hash[t[1]] + vertex_hash[t[2]], i};
  }
  std::sort(keys.begin(), keys.end(), [](const CornerKey& a, const CornerKey& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.triangle < b.triangle;
  });
  return keys;
}

/// The nearest earlier key of the same triangle, or i where there is none.
std::size_t earlier_coincident(const Mesh& mesh, const std::vector<CornerKey>& keys,
                               std::size_t i) {
  if (i == 0 || keys[i - 1].hash != keys[i].hash) return i;
  const auto corners = sorted_corners(mesh, keys[i].triangle);
  // Keys of the same hash are mostly coincident triangles.
  for (std::size_t j = i; j-- > 0 && keys[j].hash == keys[i].hash;) {
    if (sorted_corners(mesh, keys[j].triangle) == corners) return j;
  }
  return i;
}

/// True where two triangles of the same corners list them with the same winding.
bool have_same_winding(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  const auto position = [&](std::uint32_t triangle, std::size_t k) -> const Eigen::Vector3f& {
    return mesh.positions_m[mesh.triangles[triangle][k % 3]];
  };
  for (std::size_t shift = 0; shift < 3; ++shift) {
    if (position(a, 0) == position(b, shift) && position(a, 1) == position(b, shift + 1) &&
        position(a, 2) == position(b, shift + 2)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> distinct_triangles(const Mesh& mesh,
                                              const std::vector<std::uint32_t>& firsts) {
  std::vector<std::uint32_t> distinct;
  if (firsts.empty()) return distinct;
  distinct.reserve(firsts.size());
  std::vector<std::uint8_t> has_opposite(
      firsts.size(), 0);  // per first triangle: one of the other winding is kept
  for (std::uint32_t i = 0; i < firsts.size(); ++i) {
    const std::uint32_t first = firsts[i];
    const bool is_copy = first != i && have_same_winding(mesh, first, i);
    if (is_copy || has_opposite[first] != 0) continue;
    has_opposite[first] = static_cast<std::uint8_t>(first != i);
    distinct.push_back(i);
  }
  return distinct;
}

std::vector<std::uint32_t> find_first_coincident(const Mesh& mesh) {
  const std::vector<CornerKey> keys = sorted_keys(mesh);
  std::vector<std::uint32_t> first;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const std::size_t j = earlier_coincident(mesh, keys, i);
    if (j == i) continue;
    if (first.empty()) {
      first.resize(mesh.triangles.size());
      std::iota(first.begin(), first.end(), 0U);
    }
    first[keys[i].triangle] = first[keys[j].triangle];
  }
  return first;
}

}  // namespace glidar

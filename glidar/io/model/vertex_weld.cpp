// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/vertex_weld.hpp>

#include <bit>
#include <cstring>
#include <limits>

namespace glidar {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Hashes three words (multipliers of splitmix64, Steele et al. 2014).
std::uint64_t position_hash(const Eigen::Vector3f& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9E37'79B9'7F4A'7C15U;
    h ^= h >> 32U;
  }
  return h * 0xBF58'476D'1CE4'E5B9U;
}

template <class T>
bool same_bits(const std::vector<T>& values, std::size_t a, std::size_t b) {
  return values.empty() || std::memcmp(values[a].data(), values[b].data(), sizeof(T)) == 0;
}

bool same_vertex(const Mesh& m, std::size_t a, std::size_t b) {
  return same_bits(m.positions_m, a, b) && same_bits(m.normals, a, b) &&
         same_bits(m.uvs[0], a, b) && same_bits(m.uvs[1], a, b) && same_bits(m.tangents, a, b) &&
         same_bits(m.colours, a, b);
}

/// For every vertex the first one that is equal by `same`; equal ones must have the same position.
template <class Same>
std::vector<std::uint32_t> first_equal(const std::vector<Eigen::Vector3f>& positions, Same same) {
  const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
  std::vector<std::uint32_t> table(slots, kNoVertex);
  std::vector<std::uint32_t> first(positions.size());
  const int shift = 64 - std::countr_zero(slots);
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    std::size_t slot = shift < 64 ? position_hash(positions[v]) >> static_cast<unsigned>(shift) : 0;
    while (table[slot] != kNoVertex && !same(table[slot], v)) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kNoVertex) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  std::vector<T> result(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) result[i] = values[kept[i]];
  values = std::move(result);
}

}  // namespace

std::vector<std::uint32_t> first_at_position(const std::vector<Eigen::Vector3f>& positions) {
  return first_equal(positions,
                     [&](std::uint32_t a, std::uint32_t b) { return same_bits(positions, a, b); });
}

void keep_vertices(Mesh& mesh, const std::vector<std::uint32_t>& kept,
                   const std::vector<std::uint32_t>& renumbered) {
  keep(mesh.positions_m, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs[0], kept);
  keep(mesh.uvs[1], kept);
  keep(mesh.tangents, kept);
  keep(mesh.colours, kept);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = renumbered[corner];
  }
}

void weld_vertices(Mesh& mesh) {
  const std::vector<std::uint32_t> first =
      first_equal(mesh.positions_m,
                  [&mesh](std::uint32_t a, std::uint32_t b) { return same_vertex(mesh, a, b); });
  std::vector<bool> used(first.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) used[first[corner]] = true;
  }
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> renumbered(first.size(), 0);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (used[v]) {
      renumbered[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
    renumbered[v] = renumbered[first[v]];
  }
  if (kept.size() != first.size()) keep_vertices(mesh, kept, renumbered);
}

}  // namespace glidar

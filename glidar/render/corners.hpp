// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolve.hpp>

#include <algorithm>

namespace glidar {

/// A vector at each corner of a block's triangles.
struct CornerBlock {
  Lanes3<float> c0;
  Lanes3<float> c1;
  Lanes3<float> c2;
};

/// Twice the areas of the parts of a triangle around a point of its plane, signed along the normal:
/// each is opposite to its corner. All are positive inside.
struct CornerAreas {
  float at_0;
  float at_1;
  float at_2;
  float reach_squared;  ///< to the farthest corner; an area is wrong by some roundings of it
};

/// The areas around the hit point of a lane. The corners are first taken relative to the point, in
/// double, so that single precision suits the rest. Inlined, to be compiled for what its loop is.
[[gnu::always_inline]] inline CornerAreas areas_around(const ExactBlock& e, const CornerBlock& c,
                                                       unsigned i) {
  const double x = e.origin.x[i] + e.distance[i] * e.direction.x[i];
  const double y = e.origin.y[i] + e.distance[i] * e.direction.y[i];
  const double z = e.origin.z[i] + e.distance[i] * e.direction.z[i];
  const auto ax = static_cast<float>(c.c0.x[i] - x);
  const auto ay = static_cast<float>(c.c0.y[i] - y);
  const auto az = static_cast<float>(c.c0.z[i] - z);
  const auto bx = static_cast<float>(c.c1.x[i] - x);
  const auto by = static_cast<float>(c.c1.y[i] - y);
  const auto bz = static_cast<float>(c.c1.z[i] - z);
  const auto cx = static_cast<float>(c.c2.x[i] - x);
  const auto cy = static_cast<float>(c.c2.y[i] - y);
  const auto cz = static_cast<float>(c.c2.z[i] - z);
  const auto nx = static_cast<float>(e.normal.x[i]);
  const auto ny = static_cast<float>(e.normal.y[i]);
  const auto nz = static_cast<float>(e.normal.z[i]);
  const float a_squared = ax * ax + ay * ay + az * az;
  const float b_squared = bx * bx + by * by + bz * bz;
  const float c_squared = cx * cx + cy * cy + cz * cz;
  const float ab_squared = a_squared > b_squared ? a_squared : b_squared;
  return {nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx),
          nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax),
          nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx),
          ab_squared > c_squared ? ab_squared : c_squared};
}

/// Where a mesh's corners lie.
struct CornerSource {
  const Triangle* triangles;
  const Eigen::Vector3f* values;  ///< per vertex; nullptr: none
};

inline CornerSource positions_of(const Mesh& mesh) {
  return {mesh.triangles.data(), mesh.positions_m.data()};
}

/// Without normals there is no length either: then the flat normal is taken.
inline CornerSource normals_of(const Mesh& mesh) {
  return {mesh.triangles.data(), mesh.normals.empty() ? nullptr : mesh.normals.data()};
}

inline void gather_lane(const CornerSource& source, std::uint32_t primitive, unsigned lane,
                        CornerBlock& corners) {
  const Triangle& t = source.triangles[primitive];
  const auto value = [&](std::uint32_t vertex) {
    return source.values == nullptr ? Eigen::Vector3f::Zero().eval() : source.values[vertex];
  };
  corners.c0.set(lane, value(t[0]));
  corners.c1.set(lane, value(t[1]));
  corners.c2.set(lane, value(t[2]));
}

inline bool is_one_instance(const HitBlock& block) {
  return std::all_of(block.instance.begin(), block.instance.end(),
                     [&](std::uint32_t instance) { return instance == block.instance[0]; });
}

/// Collects what a mesh has at the corners of a block's triangles.
template <class SourceOf>
void gather(const Resolver& resolver, const HitBlock& block, const SourceOf& source_of,
            CornerBlock& corners) {
  const CornerSource first = source_of(resolver.mesh(block.instance[0]));
  const bool is_one = is_one_instance(block);
  for (unsigned i = 0; i < kLanes; ++i) {
    gather_lane(is_one ? first : source_of(resolver.mesh(block.instance[i])), block.primitive[i], i,
                corners);
  }
}

}  // namespace glidar

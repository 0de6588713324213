// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/settle.hpp>

#include <glidar/core/simd.hpp>
#include <glidar/render/corners.hpp>

#include <algorithm>

namespace glidar {
namespace {

// An area is a sum of six products of single precision: wrong by less than this part of the square
// of the farthest corner's distance.
constexpr float kAreaRounding = 0x1p-20F;
constexpr int kMostSteps = 8;  // from triangle to triangle, where they are smaller than the grid
// More triangles around a vertex, such as the hub of a fan, take longer than a search of all.
constexpr std::size_t kMaxAround = 256;

GLIDAR_SIMD std::uint32_t outside(const ExactBlock& e, const CornerBlock& c) {
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const CornerAreas areas = areas_around(e, c, i);
    const float ab = areas.at_0 < areas.at_1 ? areas.at_0 : areas.at_1;
    const float smallest = ab < areas.at_2 ? ab : areas.at_2;
    const int inside = static_cast<int>(smallest >= kAreaRounding * areas.reach_squared);
    const int ahead = static_cast<int>(e.distance[i] > 0.0);
    bits[i] = static_cast<std::uint32_t>((inside & ahead) ^ 1) << i;
  }
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) mask |= bits[i];
  return mask;
}

bool is_crowded(const Mesh& mesh, const Neighbours& neighbours, std::uint32_t triangle) {
  const Triangle& corners = mesh.triangles[triangle];
  return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
    return neighbours.around(vertex).size() > kMaxAround;
  });
}

}  // namespace

std::uint32_t doubtful(const Resolver& resolver, const HitBlock& block, const ExactBlock& exact) {
  CornerBlock corners;
  for (unsigned i = 0; i < kLanes; ++i) {
    const Mesh& mesh = resolver.mesh(block.instance[i]);
    corners.set(i, mesh.positions_m.data(), mesh.triangles[block.primitive[i]]);
  }
  return outside(exact, corners) & block.mask;
}

KnownMesh::KnownMesh(const Mesh& mesh) : neighbours(mesh), reach(0.0) {
  for (const Eigen::Vector3f& p : mesh.positions_m) box.extend(p.cast<double>());
  if (!box.isEmpty()) reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
}

Settler::Settler(const Resolver& resolver, const std::vector<KnownMesh>& meshes, const Beams& beams,
                 bool cull_back_faces)
    : resolver_(resolver), meshes_(meshes), beams_(beams), cull_back_faces_(cull_back_faces) {}

Judgement Settler::judgement(std::size_t beam, std::uint32_t instance) const {
  const InstanceView& view = resolver_.view(instance);
  const double reach = meshes_[resolver_.scene().instances[instance].mesh].reach;
  return {.resolver = resolver_,
          .beams = beams_,
          .beam = beam,
          .slack_m = slack(view.scale * (reach + view.sensor_in_object.norm()))};
}

/// Calls take(candidate) for the triangles around one that do not let the beam through.
template <class Take>
void Settler::for_triangles_around(std::size_t beam, const Found& middle, const Take& take) const {
  const std::uint32_t mesh = resolver_.scene().instances[middle.instance].mesh;
  for (const std::uint32_t vertex : resolver_.mesh(middle.instance).triangles[middle.primitive]) {
    for (const std::uint32_t t : meshes_[mesh].neighbours.around(vertex)) {
      const Found candidate{middle.instance, t};
      if (t != middle.primitive && meets(beam, candidate)) take(candidate);
    }
  }
}

/// Goes from a triangle to the one around it that is closest to the beam, and on, until one is met
/// or none is closer.
Found Settler::meet_around(std::size_t beam, const Found& told) const {
  Judgement found = judgement(beam, told.instance);
  if (meets(beam, told)) found.consider(told);
  if (found.is_clear()) return told;
  const Mesh& mesh = resolver_.mesh(told.instance);
  const Neighbours& neighbours =
      meshes_[resolver_.scene().instances[told.instance].mesh].neighbours;
  if (is_crowded(mesh, neighbours, told.primitive)) return {};
  const auto consider = [&](const Found& candidate) { found.consider(candidate); };
  for_triangles_around(beam, told, consider);
  Found middle = told;
  for (int step = 1; step < kMostSteps && found.nearest.instance == kNoHit; ++step) {
    if (found.closest.instance == kNoHit || found.closest == middle) break;
    middle = found.closest;
    if (is_crowded(mesh, neighbours, middle.primitive)) return {};
    for_triangles_around(beam, middle, consider);
  }
  if (found.nearest.instance == kNoHit) return {};
  middle = found.nearest;
  if (is_crowded(mesh, neighbours, middle.primitive)) return {};
  for_triangles_around(beam, middle, [&](const Found& tied) { found.consider_tie(tied); });
  return found.nearest;
}

}  // namespace glidar

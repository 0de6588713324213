// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/settle.hpp>

#include <glidar/core/simd.hpp>
#include <glidar/render/corners.hpp>
#include <glidar/render/surface.hpp>

#include <algorithm>

namespace glidar {
namespace {

// An area is a sum of six products of single precision: wrong by less than this part of the square
// of the farthest corner's distance.
constexpr float kAreaRounding = 0x1p-20F;
constexpr int kMostSteps = 8;  // from triangle to triangle, where they are smaller than the grid

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

/// The weights of corners 1 and 2 where a beam meets a triangle's plane.
Eigen::Vector2f weights(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d v0 = mesh.positions_m[t[0]].cast<double>();
  const Eigen::Vector3d e1 = mesh.positions_m[t[1]].cast<double>() - v0;
  const Eigen::Vector3d e2 = mesh.positions_m[t[2]].cast<double>() - v0;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double whole = normal.squaredNorm();
  const Eigen::Vector3d from = point - v0;
  return Eigen::Vector2d(normal.dot(from.cross(e2)) / whole, normal.dot(e1.cross(from)) / whole)
      .cast<float>();
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

void Settler::consider(Judgement& judgement, const Found& candidate) const {
  if (meets(judgement.beam, candidate)) judgement.consider(candidate);
}

bool Settler::meets(std::size_t beam, const Found& candidate) const {
  const Instance& instance = resolver_.scene().instances[candidate.instance];
  const Mesh& mesh = resolver_.mesh(candidate.instance);
  const ObjectRay ray = ray_in(resolver_.view(candidate.instance), beams_, beam);
  const TrianglePlane& plane = resolver_.plane(candidate.instance, candidate.primitive);
  if (cull_back_faces_ && plane.normal.dot(ray.direction) > 0.0) return false;
  const std::uint16_t slot = material_slot(mesh, candidate.primitive);
  if (!(resolver_.scene().materials[instance.materials[slot]].alpha_cutoff > 0.0F)) return true;
  const Eigen::Vector3d point = ray.origin + distance_to(plane, ray) * ray.direction;
  const SurfacePlace place{mesh, instance, candidate.primitive,
                           weights(mesh, candidate.primitive, point)};
  return !is_cut_out(resolver_.scene(), place);
}

void Settler::consider_around(Judgement& judgement, const Found& middle) const {
  const std::uint32_t mesh = resolver_.scene().instances[middle.instance].mesh;
  for (const std::uint32_t vertex : resolver_.mesh(middle.instance).triangles[middle.primitive]) {
    for (const std::uint32_t t : meshes_[mesh].neighbours.around(vertex)) {
      if (t != middle.primitive) consider(judgement, {middle.instance, t});
    }
  }
}

/// Goes from a triangle to the one around it that is closest to the beam, and on, until one is met
/// or none is closer.
Judgement Settler::search_from(std::size_t beam, const Found& start) const {
  Judgement found = judgement(beam, start.instance);
  consider(found, start);
  Found middle = start;
  for (int step = 0; step < kMostSteps && found.nearest.instance == kNoHit; ++step) {
    consider_around(found, middle);
    if (found.closest.instance == kNoHit || found.closest == middle) break;
    middle = found.closest;
  }
  return found;
}

Found Settler::nearest_of(std::size_t beam, std::span<const Found> candidates) const {
  if (candidates.empty()) return {};
  Judgement all = judgement(beam, candidates.front().instance);
  for (const Found& candidate : candidates) {
    all.slack_m = judgement(beam, candidate.instance).slack_m;
    consider(all, candidate);
  }
  return all.nearest;
}

Found Settler::settle(std::size_t beam, const Found& told, std::span<const Found> around) const {
  const Judgement first = search_from(beam, told);
  if (first.nearest.instance != kNoHit) return first.nearest;

  Judgement all = first;
  bool passes = false;
  for (const Found& other : around) {
    passes = passes || other.instance == kNoHit;
    if (other.instance == kNoHit || other == told) continue;
    const Judgement found = search_from(beam, other);
    const Found& best = found.nearest.instance == kNoHit ? found.closest : found.nearest;
    if (best.instance != kNoHit) all.consider(best);
  }
  if (all.nearest.instance != kNoHit) return all.nearest;
  return passes ? Found{} : all.closest;
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/judgement.hpp>
#include <glidar/render/neighbours.hpp>
#include <glidar/render/resolve.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// A bit for every hit lane whose beam may pass beside its triangle or start behind it.
std::uint32_t doubtful(const Resolver& resolver, const HitBlock& block, const ExactBlock& exact);

/// What is worked out once of a mesh.
struct KnownMesh {
  explicit KnownMesh(const Mesh& mesh);

  Neighbours neighbours;
  Eigen::AlignedBox3d box;  ///< relative to the mesh's origin
  double reach;             ///< from there to its farthest corner
};

/// Puts right what a rasterizer told. It moves corners to a grid of 1/256 of a pixel (or coarser),
/// so a beam so near a border may be told the triangle on its other side. The true one is then
/// among the triangles around, or the beam passes the silhouette.
class Settler {
 public:
  /// Everything must outlive the settler.
  Settler(const Resolver& resolver, const std::vector<KnownMesh>& meshes, const Beams& beams,
          bool cull_back_faces);

  /// What the beam meets, from what was told at its pixel and at the pixels around it (kNoHit where
  /// nothing was).
  [[nodiscard]] Found settle(std::size_t beam, const Found& told,
                             std::span<const Found> around) const;

  /// What the beam meets among the triangles around the one told; nothing when it meets none.
  [[nodiscard]] Found meet_around(std::size_t beam, const Found& told) const {
    return search_from(beam, told).nearest;
  }

  /// The nearest of these that the beam meets; nothing when it meets none.
  [[nodiscard]] Found nearest_of(std::size_t beam, std::span<const Found> candidates) const;

  /// False where a triangle lets a beam through: by its side, or by a hole of its alpha mask.
  [[nodiscard]] bool meets(std::size_t beam, const Found& candidate) const;

 private:
  [[nodiscard]] Judgement judgement(std::size_t beam, std::uint32_t instance) const;
  void consider(Judgement& judgement, const Found& candidate) const;
  void consider_around(Judgement& judgement, const Found& middle) const;
  [[nodiscard]] Judgement search_from(std::size_t beam, const Found& start) const;

  const Resolver& resolver_;
  const std::vector<KnownMesh>& meshes_;
  const Beams& beams_;
  bool cull_back_faces_;
};

}  // namespace glidar

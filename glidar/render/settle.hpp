// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/judgement.hpp>
#include <glidar/render/neighbours.hpp>
#include <glidar/render/resolve.hpp>

#include <Eigen/Geometry>
#include <cstdint>
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

  /// What the beam meets among the triangles around the one told, the lowest of those that meet
  /// where it does; nothing when it meets none, or when there are so many that a search of all is
  /// quicker.
  [[nodiscard]] Found meet_around(std::size_t beam, const Found& told) const;

  /// See stops().
  [[nodiscard]] bool meets(std::size_t beam, const Found& candidate) const {
    return stops(resolver_, beams_, beam, cull_back_faces_, candidate);
  }

 private:
  [[nodiscard]] Judgement judgement(std::size_t beam, std::uint32_t instance) const;
  template <class Take>
  void for_triangles_around(std::size_t beam, const Found& middle, const Take& take) const;

  const Resolver& resolver_;
  const std::vector<KnownMesh>& meshes_;
  const Beams& beams_;
  bool cull_back_faces_;
};

}  // namespace glidar

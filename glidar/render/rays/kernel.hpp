// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/cones.hpp>
#include <glidar/render/rays/ray_tree.hpp>

namespace glidar::rays {

/// Processes the rays of `lanes` in a leaf. May lower packet.high of these.
using VisitLeaf = void (*)(void* context, std::uint32_t leaf, RayPacket& packet,
                           std::uint32_t lanes);

/// The inner loops, compiled for one instruction set. kernel.cpp is compiled once for each, with
/// GLIDAR_KERNEL as its name.
struct Kernel {
  const char* name;  ///< "baseline", "avx2", "avx512"
  /// Completes a packet whose rays are set, for a mesh and the rays of the mask `active` (at least
  /// one), without hits.
  void (*start)(RayPacket& packet, const MeshSphere& sphere, std::uint32_t active);
  /// Tests the rays of `lanes` with the triangles of a cluster.
  void (*test_leaf)(const TreeView& tree, std::uint32_t cluster, RayPacket& packet,
                    std::uint32_t lanes);
  /// Finds the nearest triangle of every active ray of a started packet.
  void (*trace)(const TreeView& tree, RayPacket& packet);
  /// The same for one ray at a time: for rays in unrelated directions.
  void (*trace_single)(const TreeView& tree, RayPacket& packet);
  /// Calls visit() for the leaves that rays of a started packet enter before packet.high, in about
  /// the order of distance. The tree needs no clusters and blocks.
  void (*visit_leaves)(const TreeView& tree, RayPacket& packet, VisitLeaf visit, void* context);
  /// Adds the hits of all active cones to `cones`. The packet was started with a sphere so much
  /// larger that no ray of a cone is in the mesh's sphere before its shift.
  void (*trace_cones)(const TreeView& tree, RayPacket& packet, Cones& cones);
  /// As visit_leaves(), for the leaves that rays of cones may enter.
  void (*visit_cone_leaves)(const TreeView& tree, RayPacket& packet, Cones& cones, VisitLeaf visit,
                            void* context);
};

}  // namespace glidar::rays

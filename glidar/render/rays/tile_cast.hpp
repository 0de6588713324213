// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/renderer.hpp>

#include <cstdint>
#include <vector>

namespace glidar::rays {

/// How the hits of runs of beams are found, if not beam by beam by the search.
struct HitFinder {
  FunctionRef<void(BeamRange)> find = {};  ///< sets instance and primitive of every beam of a run
  std::uint32_t beams_at_once = 1;         ///< every run is a multiple of it, or the last one
  bool finds_all = false;                  ///< find() sets all columns of the request
};

/// Casts requests tile by tile on the threads of a renderer.
class TileCast {
 public:
  /// The base must outlive this.
  explicit TileCast(CpuBase& base);

  /// Prepares resolver and search for a request and resizes its hits; false if there is nothing to
  /// be hit: then it writes misses, and the cast is done.
  [[nodiscard]] bool prepare(const CastRequest& request, Hits& hits);

  /// Casts the request that was prepared last.
  void cast(const CastRequest& request, const HitFinder& finder, Hits& hits);

 private:
  CpuBase& base_;
  PlanePoints points_;
  std::vector<Eigen::AlignedBox3d> mesh_boxes_;  ///< per mesh, in the object's frame
};

}  // namespace glidar::rays

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/render/rays/scene_trees.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Finds coincident or nearly coincident triangles of one mesh. A rasterizer cannot decide which of
/// two triangles is nearer when the gap between them is below its resolution.
class CloseTriangles {
 public:
  /// Compares each triangle with its neighbours; resolver and trees must outlive this. Boxes: one
  /// per mesh, relative to its origin.
  CloseTriangles(const Resolver& resolver, const rays::SceneTrees& trees,
                 std::span<const Eigen::AlignedBox3d> boxes, ThreadPool& thread_pool);

  /// Prepares the next cast; the resolver has its poses. The driver moves what it draws by up to
  /// band_px.
  void prepare(const CastRequest& request, double band_px);

  /// True where another triangle of the mesh may be so close to this one that a rasterizer may show
  /// either. `primitive`: see Resolver::canonical_primitive().
  [[nodiscard]] bool is_close(std::uint32_t instance, std::uint32_t primitive) const {
    const Closeness& closeness = closeness_[instance];
    if (closeness.bits == nullptr) return closeness.has_all;
    return (closeness.bits[primitive / 64] >> primitive % 64 & 1U) != 0;
  }

 private:
  /// A triangle and the gap to the nearest other one, object units.
  struct Gap {
    std::uint32_t primitive;
    float size;
  };
  /// State of one instance.
  struct Closeness {
    const std::uint64_t* bits;  ///< one per triangle; nullptr: all or none are close
    bool has_all;
  };

  void set_bits(std::uint32_t mesh);

  const Resolver& resolver_;
  const rays::SceneTrees& trees_;
  std::span<const Eigen::AlignedBox3d> boxes_;
  std::vector<std::vector<Gap>> gaps_;            ///< per mesh
  std::vector<std::vector<std::uint64_t>> bits_;  ///< per mesh; empty: no triangle is close
  std::vector<double> limits_;                    ///< per mesh: gaps up to it are close
  std::vector<Closeness> closeness_;              ///< per instance
};

}  // namespace glidar

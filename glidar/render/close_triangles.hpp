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

/// Finds triangles of one mesh that lie on each other or nearly so: a drawn picture does not show
/// which of two sheets is nearer when they are closer together than it resolves.
class CloseTriangles {
 public:
  /// Compares each triangle with those around it; both must outlive this. Boxes: one per mesh,
  /// relative to its origin.
  CloseTriangles(const Resolver& resolver, const rays::SceneTrees& trees,
                 std::span<const Eigen::AlignedBox3d> boxes, ThreadPool& thread_pool);

  /// Takes the poses of the next cast, which the resolver has. The driver moves what it draws by
  /// up to band_px.
  void prepare(const CastRequest& request, double band_px);

  /// For a triangle as Resolver::canonical_primitive() names it: true where another sheet of the
  /// mesh may be so close to the triangle that the picture may show either.
  [[nodiscard]] bool is_close(std::uint32_t instance, std::uint32_t primitive) const {
    const Closeness& closeness = closeness_[instance];
    if (closeness.bits == nullptr) return closeness.has_all;
    return (closeness.bits[primitive / 64] >> primitive % 64 & 1U) != 0;
  }

 private:
  /// A triangle and how far the nearest other sheet is, object units.
  struct Gap {
    std::uint32_t primitive;
    float size;
  };
  /// Of one instance.
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
  std::vector<double> limits_;                    ///< per mesh: sheets closer than it are close
  std::vector<Closeness> closeness_;              ///< per instance
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>

namespace glidar {

/// A point on a mesh: a triangle and the barycentric weights of its corners 1 and 2.
struct SurfacePoint {
  const Mesh& mesh;
  const Instance& instance;
  std::uint32_t triangle;
  Eigen::Vector2f weights;
};

/// The material at a point.
const Material& material_at(const Scene& scene, const SurfacePoint& surface_point);

/// The texture coordinate at a point; zero where the mesh has none.
Eigen::Vector2f uv_at(const SurfacePoint& surface_point, std::uint8_t uv_set);

/// True when the material's alpha mask is transparent at the point.
bool is_cut_out(const Scene& scene, const SurfacePoint& surface_point);

/// True when the material has a normal map that applies to the mesh.
bool has_normal_map(const Material& material, const Mesh& mesh);

/// The unit normal `smooth` after the material's normal map, in the object frame on the front side.
Eigen::Vector3f apply_normal_map(const Scene& scene, const SurfacePoint& surface_point,
                                 const Eigen::Vector3f& smooth);

}  // namespace glidar

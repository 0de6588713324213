// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

using Triangle = std::array<std::uint32_t, 3>;

/// A triangle mesh in its own object frame (metres, right-handed).
/// A vertex stands at `origin_m + positions_m[i]`: single precision is kept only relative to an
/// origin nearby, so that a mesh far from its frame's zero loses no detail.
/// V vertices, T triangles. The front of a triangle is where its corners run counter-clockwise.
struct Mesh {
  std::string name;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> positions_m;  ///< V; with room for one more, renderers need no copy
  std::vector<Eigen::Vector3f> normals;      ///< V unit vectors; empty: flat shading
  std::array<std::vector<Eigen::Vector2f>, 2> uvs;  ///< two sets of V, v upwards; empty: none
  std::vector<Eigen::Vector4f>
      tangents;  ///< V, xyz along +u, w = sign of the bitangent; empty: none
  std::vector<Eigen::Vector3f>
      colours;                      ///< V, rgb 0..1, multiplies the diffuse colour; empty: white
  std::vector<Triangle> triangles;  ///< T, each corner < V
  std::vector<std::uint16_t> material_slots;  ///< T, index into Instance::materials; empty: all 0
};

/// The box around all finite vertices, in the object frame; empty box for an empty mesh.
Eigen::AlignedBox3d bounds(const Mesh& mesh);

/// The slot of a triangle's material.
inline std::uint16_t material_slot(const Mesh& mesh, std::uint32_t triangle) {
  return mesh.material_slots.empty() ? std::uint16_t{0} : mesh.material_slots[triangle];
}

/// One past the largest slot that a triangle uses (at least 1).
std::uint32_t slot_count(const Mesh& mesh);

/// Throws Error unless every array has its stated size, every corner is a vertex and every
/// position is finite.
void validate(const Mesh& mesh);

}  // namespace glidar

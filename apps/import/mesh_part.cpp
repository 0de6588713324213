// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mesh_part.hpp>

#include <glidar/io/model/vertex_attributes.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::import {
namespace {

Eigen::Vector3d moved(const Placed& placed, const Eigen::Vector3d& v) {
  return placed.model_from_mesh.topLeftCorner<3, 3>() * v +
         placed.model_from_mesh.topRightCorner<3, 1>();
}

/// Whether a position is in the range of single precision, also for rounded origins.
bool is_representable(const Eigen::Vector3d& p) {
  return p.cast<float>().allFinite();
}

/// Replaces -0 by +0, because positions are compared by their bits later.
Eigen::Vector3f plain(const Eigen::Vector3d& v) {
  return (v.cast<float>().array() + 0.0F).matrix();
}

Eigen::Vector2f finite_uv(const Eigen::Vector2f& uv) {
  return {std::isfinite(uv.x()) ? uv.x() : 0.0F, std::isfinite(uv.y()) ? uv.y() : 0.0F};
}

float unit_range(float value) {
  return std::isnan(value) ? 1.0F : std::clamp(value, 0.0F, 1.0F);
}

Eigen::Vector3f unit_or_zero(const Eigen::Vector3d& v) {
  const double length = v.norm();
  if (!std::isfinite(length) || length < 1e-30) return Eigen::Vector3f::Zero();
  return (v / length).cast<float>();
}

struct Linear {
  Eigen::Matrix3d directions;  ///< for tangents
  Eigen::Matrix3d normals;     ///< inverse transpose, up to a positive factor
  double handedness = 1.0;     ///< -1: mirrored
};

Linear linear_part(const Placed& placed) {
  const Eigen::Matrix3d m = placed.model_from_mesh.topLeftCorner<3, 3>();
  Linear linear;
  linear.directions = m;
  linear.handedness = m.determinant() < 0.0 ? -1.0 : 1.0;
  // The cofactor matrix is det(m) times the inverse transpose; it also exists for flat parts.
  linear.normals.col(0) = m.col(1).cross(m.col(2));
  linear.normals.col(1) = m.col(2).cross(m.col(0));
  linear.normals.col(2) = m.col(0).cross(m.col(1));
  linear.normals *= linear.handedness;
  return linear;
}

/// Computes positions relative to the origin. False for vertices that are not finite in any of the
/// three frames.
std::vector<bool> copy_positions(const SourceMesh& mesh, const Placed& placed,
                                 const Eigen::Vector3d& origin, Mesh& part) {
  std::vector<bool> finite(mesh.positions.size());
  part.positions_m.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3d in_model = moved(placed, mesh.positions[v]);
    const Eigen::Vector3f p = plain(in_model - origin);
    finite[v] = is_representable(in_model) && p.allFinite();
    part.positions_m[v] = finite[v] ? p : Eigen::Vector3f::Zero();
  }
  return finite;
}

/// Counts the faces with all their triangles.
std::uint64_t copy_triangles(const SourceMesh& mesh, const std::vector<bool>& finite, bool mirrored,
                             Mesh& part) {
  part.triangles.reserve(mesh.triangles.size());
  std::uint64_t faces = 0;
  std::size_t next_face = 0;
  bool is_whole = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool begins = mesh.first_of_face.empty() || (next_face < mesh.first_of_face.size() &&
                                                       mesh.first_of_face[next_face] == t);
    if (begins) {
      faces += t > 0 && is_whole ? 1 : 0;
      is_whole = true;
      ++next_face;
    }
    const auto& [a, b, c] = mesh.triangles[t];
    if (finite[a] && finite[b] && finite[c]) {
      part.triangles.push_back({a, mirrored ? c : b, mirrored ? b : c});
    } else {
      is_whole = false;
    }
  }
  return faces + (!mesh.triangles.empty() && is_whole ? 1 : 0);
}

void copy_normals(const SourceMesh& mesh, const Linear& linear, Mesh& part) {
  part.normals.resize(mesh.normals.size());
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    part.normals[v] = unit_or_zero(linear.normals * mesh.normals[v].cast<double>());
  }
}

/// The file's tangents; w is the handedness of their bitangents.
void copy_tangents(const SourceMesh& mesh, const Linear& linear, Mesh& part) {
  part.tangents.resize(mesh.tangents.size());
  for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
    const Eigen::Vector4f& t = mesh.tangents[v];
    Eigen::Vector3f u = unit_or_zero(linear.directions * t.head<3>().cast<double>());
    if (u.isZero(0.0F)) u = Eigen::Vector3f::UnitX();
    const double side = t.w() < 0.0F ? -1.0 : 1.0;
    part.tangents[v] = {u.x(), u.y(), u.z(), static_cast<float>(side * linear.handedness)};
  }
}

void copy_uvs_and_colours(const SourceMesh& mesh, Mesh& part) {
  for (std::size_t set = 0; set < part.uvs.size(); ++set) {
    part.uvs[set].reserve(mesh.uvs[set].size());
    for (const Eigen::Vector2f& uv : mesh.uvs[set]) part.uvs[set].push_back(finite_uv(uv));
  }
  part.colours.reserve(mesh.colours.size());
  for (const Eigen::Vector3f& c : mesh.colours) part.colours.push_back(c.unaryExpr(&unit_range));
}

/// Replaces unusable normals by those of the adjacent faces.
void mend_normals(Mesh& part, Repairs& repairs) {
  std::vector<bool> bad(part.normals.size());
  std::uint64_t count = 0;
  for (std::size_t v = 0; v < bad.size(); ++v) {
    bad[v] = part.normals[v].isZero(0.0F);
    count += bad[v] ? 1 : 0;
  }
  if (count == 0) return;
  repairs.bad_normals += count;
  std::vector<Eigen::Vector3f> sums(part.normals.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : part.triangles) {
    const Eigen::Vector3f& a = part.positions_m[t[0]];
    const Eigen::Vector3f n = (part.positions_m[t[1]] - a).cross(part.positions_m[t[2]] - a);
    for (const std::uint32_t v : t) sums[v] += n;
  }
  for (std::size_t v = 0; v < bad.size(); ++v) {
    if (!bad[v]) continue;
    const Eigen::Vector3f made = unit_or_zero(sums[v].cast<double>());
    part.normals[v] = made.isZero(0.0F) ? Eigen::Vector3f::UnitZ().eval() : made;
  }
}

/// Vertices that no triangle uses.
std::uint64_t unused(const Mesh& part) {
  std::vector<bool> used(part.positions_m.size(), false);
  for (const Triangle& t : part.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
}

}  // namespace

void for_used_vertices(const SourceMesh& mesh, const Placed& placed,
                       const std::function<void(const Eigen::Vector3d&)>& visit) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (!used[v]) continue;
    const Eigen::Vector3d p = moved(placed, mesh.positions[v]);
    if (is_representable(p)) visit(p);
  }
}

Mesh make_part(SourceMesh& mesh, const Placed& placed, const Eigen::Vector3d& origin,
               const BakeNeeds& needs, Repairs& repairs) {
  const Linear linear = linear_part(placed);
  Mesh part;
  {
    const std::vector<bool> finite = copy_positions(mesh, placed, origin, part);
    repairs.whole_faces += copy_triangles(mesh, finite, linear.handedness < 0.0, part);
  }
  repairs.not_finite += mesh.triangles.size() - part.triangles.size();
  repairs.unused_vertices += unused(part);
  copy_uvs_and_colours(mesh, part);
  copy_normals(mesh, linear, part);
  if (!mesh.normals.empty()) copy_tangents(mesh, linear, part);
  if (needs.is_last) mesh = {};
  weld_vertices(part);
  if (!part.normals.empty()) {
    mend_normals(part, repairs);
  } else {
    // Welded ones have the same position only if they differ in something else.
    const bool are_distinct = part.uvs[0].empty() && part.uvs[1].empty() && part.colours.empty();
    make_normals(part, needs.crease_angle_rad, are_distinct);
  }
  const bool can_have_tangents = needs.tangents && !part.uvs[needs.normal_uv].empty();
  if (can_have_tangents && part.tangents.empty()) make_tangents(part, needs.normal_uv);
  if (!needs.tangents) part.tangents.clear();
  return part;
}

}  // namespace glidar::import

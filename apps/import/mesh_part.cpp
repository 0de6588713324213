// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mesh_part.hpp>

#include <glidar/io/model/crease_normals.hpp>
#include <glidar/io/model/tangents.hpp>
#include <glidar/io/model/vertex_weld.hpp>

#include <assimp/mesh.h>

#include <algorithm>
#include <cmath>

namespace glidar::import {
namespace {

Eigen::Vector3d vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

Eigen::Vector3d moved(const Placed& placed, const aiVector3D& v) {
  return placed.model_from_mesh.topLeftCorner<3, 3>() * vector(v) +
         placed.model_from_mesh.topRightCorner<3, 1>();
}

/// Whether a position is in the range of single precision, also for rounded origins.
bool is_representable(const Eigen::Vector3d& p) {
  return p.cast<float>().allFinite();
}

/// Whether a face is a triangle with valid vertices.
bool is_triangle(const aiFace& face, unsigned vertices) {
  return face.mNumIndices == 3 && face.mIndices[0] < vertices && face.mIndices[1] < vertices &&
         face.mIndices[2] < vertices;
}

/// Replaces -0 by +0, because positions are compared by their bits later.
Eigen::Vector3f plain(const Eigen::Vector3d& v) {
  return (v.cast<float>().array() + 0.0F).matrix();
}

Eigen::Vector2f finite_uv(const aiVector3D& uv) {
  return {std::isfinite(uv.x) ? uv.x : 0.0F, std::isfinite(uv.y) ? uv.y : 0.0F};
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
std::vector<bool> copy_positions(const Placed& placed, const Eigen::Vector3d& origin, Mesh& part) {
  const aiMesh& mesh = *placed.mesh;
  std::vector<bool> finite(mesh.mNumVertices);
  part.positions_m.resize(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const Eigen::Vector3d in_model = moved(placed, mesh.mVertices[v]);
    const Eigen::Vector3f p = plain(in_model - origin);
    finite[v] = is_representable(in_model) && p.allFinite();
    part.positions_m[v] = finite[v] ? p : Eigen::Vector3f::Zero();
  }
  return finite;
}

void copy_triangles(const aiMesh& mesh, const std::vector<bool>& finite, bool mirrored, Mesh& part,
                    Repairs& repairs) {
  part.triangles.reserve(mesh.mNumFaces);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (!is_triangle(face, mesh.mNumVertices)) continue;
    const unsigned a = face.mIndices[0];
    const unsigned b = face.mIndices[mirrored ? 2 : 1];
    const unsigned c = face.mIndices[mirrored ? 1 : 2];
    if (finite[a] && finite[b] && finite[c]) {
      part.triangles.push_back({a, b, c});
    } else {
      ++repairs.not_finite;
    }
  }
}

void copy_normals(const aiMesh& mesh, const Linear& linear, Mesh& part) {
  part.normals.resize(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    part.normals[v] = unit_or_zero(linear.normals * vector(mesh.mNormals[v]));
  }
}

/// The file's tangents; w is the handedness of their bitangents.
void copy_tangents(const aiMesh& mesh, const Linear& linear, Mesh& part) {
  part.tangents.resize(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const Eigen::Vector3d t = vector(mesh.mTangents[v]);
    const Eigen::Vector3d b = vector(mesh.mBitangents[v]);
    const double side = vector(mesh.mNormals[v]).cross(t).dot(b) < 0.0 ? -1.0 : 1.0;
    Eigen::Vector3f u = unit_or_zero(linear.directions * t);
    if (u.isZero(0.0F)) u = Eigen::Vector3f::UnitX();
    part.tangents[v] = {u.x(), u.y(), u.z(), static_cast<float>(side * linear.handedness)};
  }
}

void copy_uvs_and_colours(const aiMesh& mesh, Mesh& part) {
  for (unsigned set = 0; set < part.uvs.size(); ++set) {
    if (!mesh.HasTextureCoords(set)) continue;
    part.uvs[set].resize(mesh.mNumVertices);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      part.uvs[set][v] = finite_uv(mesh.mTextureCoords[set][v]);
    }
  }
  if (!mesh.HasVertexColors(0)) return;
  part.colours.resize(mesh.mNumVertices);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiColor4D& c = mesh.mColors[0][v];
    part.colours[v] = {unit_range(c.r), unit_range(c.g), unit_range(c.b)};
  }
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

std::uint64_t unused(const aiMesh& mesh, const Mesh& part) {
  std::vector<bool> used(mesh.mNumVertices, false);
  for (const Triangle& t : part.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
}

}  // namespace

std::size_t material_of(const Placed& placed) {
  return placed.mesh->mMaterialIndex;
}

void for_used_vertices(const Placed& placed,
                       const std::function<void(const Eigen::Vector3d&)>& visit) {
  const aiMesh& mesh = *placed.mesh;
  std::vector<bool> used(mesh.mNumVertices, false);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (!is_triangle(face, mesh.mNumVertices)) continue;
    for (unsigned k = 0; k < 3; ++k) used[face.mIndices[k]] = true;
  }
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    if (!used[v]) continue;
    const Eigen::Vector3d p = moved(placed, mesh.mVertices[v]);
    if (is_representable(p)) visit(p);
  }
}

Mesh make_part(const Placed& placed, const Eigen::Vector3d& origin, const BakeOptions& options,
               const SlotNeeds& needs, Repairs& repairs) {
  const aiMesh& mesh = *placed.mesh;
  const Linear linear = linear_part(placed);
  const bool file_normals = mesh.HasNormals() && !options.facet_normals;
  Mesh part;
  const std::vector<bool> finite = copy_positions(placed, origin, part);
  copy_triangles(mesh, finite, linear.handedness < 0.0, part, repairs);
  repairs.unused_vertices += unused(mesh, part);
  copy_uvs_and_colours(mesh, part);
  if (file_normals) copy_normals(mesh, linear, part);
  if (file_normals && mesh.HasTangentsAndBitangents()) copy_tangents(mesh, linear, part);
  weld_vertices(part);
  if (file_normals) {
    mend_normals(part, repairs);
  } else {
    make_normals(part, options.crease_angle_rad);
  }
  const bool can_have_tangents = needs.tangents && !part.uvs[needs.normal_uv].empty();
  if (can_have_tangents && part.tangents.empty()) make_tangents(part, needs.normal_uv);
  if (!needs.tangents) part.tangents.clear();
  return part;
}

}  // namespace glidar::import

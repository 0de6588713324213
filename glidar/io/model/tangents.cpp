// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/tangents.hpp>

#include <glidar/io/model/corner_angle.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct FaceTangent {
  Eigen::Vector3f along_u = Eigen::Vector3f::Zero();  ///< unit, zero without a uv area
  bool mirrored = false;
};

FaceTangent face_tangent(const Mesh& mesh, const Triangle& t, std::size_t uv_set) {
  const auto& uv = mesh.uvs[uv_set];
  const Eigen::Vector3d p1 = (mesh.positions_m[t[1]] - mesh.positions_m[t[0]]).cast<double>();
  const Eigen::Vector3d p2 = (mesh.positions_m[t[2]] - mesh.positions_m[t[0]]).cast<double>();
  const Eigen::Vector2d d1 = (uv[t[1]] - uv[t[0]]).cast<double>();
  const Eigen::Vector2d d2 = (uv[t[2]] - uv[t[0]]).cast<double>();
  const double area = d1.x() * d2.y() - d2.x() * d1.y();
  const Eigen::Vector3d u = (p1 * d2.y() - p2 * d1.y()) * (area < 0.0 ? -1.0 : 1.0);
  const double length = u.norm();
  FaceTangent result;
  result.mirrored = area < 0.0;
  if (area != 0.0 && length > 0.0 && std::isfinite(length)) {
    result.along_u = (u / length).cast<float>();
  }
  return result;
}

float corner_angle(const Mesh& mesh, const Triangle& t, std::size_t k) {
  const Eigen::Vector3f& at = mesh.positions_m[t[k]];
  return angle_between_rad(mesh.positions_m[t[(k + 1) % 3]] - at,
                           mesh.positions_m[t[(k + 2) % 3]] - at);
}

Eigen::Vector3f in_plane(const Eigen::Vector3f& v, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f flat = v - v.dot(normal) * normal;
  const float length = flat.norm();
  return length > 1e-6F ? Eigen::Vector3f(flat / length) : Eigen::Vector3f::Zero();
}

template <class T>
void repeat(std::vector<T>& values, std::uint32_t vertex) {
  if (!values.empty()) values.push_back(T(values[vertex]));
}

std::uint32_t repeat_vertex(Mesh& mesh, std::uint32_t vertex) {
  repeat(mesh.positions_m, vertex);
  repeat(mesh.normals, vertex);
  repeat(mesh.uvs[0], vertex);
  repeat(mesh.uvs[1], vertex);
  repeat(mesh.colours, vertex);
  return static_cast<std::uint32_t>(mesh.positions_m.size() - 1);
}

/// Vertices that unmirrored faces use.
std::vector<bool> used_plainly(const Mesh& mesh, const std::vector<FaceTangent>& faces) {
  std::vector<bool> plain(mesh.positions_m.size(), false);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].mirrored) continue;
    for (const std::uint32_t v : mesh.triangles[f]) plain[v] = true;
  }
  return plain;
}

/// Splits vertices that mirrored and unmirrored faces share.
/// Returns for every vertex whether its uvs are mirrored.
std::vector<bool> split_mirrored(Mesh& mesh, const std::vector<FaceTangent>& faces) {
  const std::vector<bool> plain = used_plainly(mesh, faces);
  std::vector<std::uint32_t> repeated(plain.size(), kNone);
  std::vector<bool> mirrored(plain.size(), false);
  const auto repeat_of = [&](std::uint32_t v) {
    if (plain[v] && repeated[v] == kNone) {
      repeated[v] = repeat_vertex(mesh, v);
      mirrored.push_back(true);
    }
    if (!plain[v]) mirrored[v] = true;
    return plain[v] ? repeated[v] : v;
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].mirrored) continue;
    for (std::uint32_t& v : mesh.triangles[f]) v = repeat_of(v);
  }
  return mirrored;
}

}  // namespace

void make_tangents(Mesh& mesh, std::size_t uv_set) {
  std::vector<FaceTangent> faces;
  faces.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) faces.push_back(face_tangent(mesh, t, uv_set));
  const std::vector<bool> mirrored = split_mirrored(mesh, faces);
  std::vector<Eigen::Vector3f> sums(mesh.positions_m.size(), Eigen::Vector3f::Zero());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      sums[t[k]] += corner_angle(mesh, t, k) * in_plane(faces[f].along_u, mesh.normals[t[k]]);
    }
  }
  mesh.tangents.resize(mesh.positions_m.size());
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Eigen::Vector3f flat = in_plane(sums[v], mesh.normals[v]);
    const Eigen::Vector3f u =
        flat.isZero(0.0F) ? Eigen::Vector3f(mesh.normals[v].unitOrthogonal()) : flat;
    mesh.tangents[v] = {u.x(), u.y(), u.z(), mirrored[v] ? -1.0F : 1.0F};
  }
}

}  // namespace glidar

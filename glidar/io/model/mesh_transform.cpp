// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/mesh_transform.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidar {
namespace {

template <class V>
void turn(V& v, Axis up) {
  using S = typename V::Scalar;
  const S x = v.x();
  const S y = v.y();
  const S z = v.z();
  if (up == Axis::y) {
    v.y() = S{0} - z;  // never -0
    v.z() = y;
  } else if (up == Axis::x) {
    v.x() = y;
    v.y() = z;
    v.z() = x;
  }
}

/// Calls change(origin) for every origin of the mesh.
template <class Change>
void for_origins(Mesh& mesh, const Change& change) {
  change(mesh.origin_m);
  for (MeshOrigin& run : mesh.origins) change(run.origin_m);
}

void turn_mesh(Mesh& mesh, Axis up) {
  for_origins(mesh, [up](Eigen::Vector3d& origin_m) { turn(origin_m, up); });
  for (auto& v : mesh.positions_m) turn(v, up);
  for (auto& v : mesh.normals) turn(v, up);
  for (auto& v : mesh.tangents) turn(v, up);
}

bool is_finite(Mesh& mesh) {
  bool finite = std::all_of(mesh.positions_m.begin(), mesh.positions_m.end(),
                            [](const Eigen::Vector3f& v) { return v.allFinite(); });
  for_origins(mesh,
              [&](const Eigen::Vector3d& origin_m) { finite = finite && origin_m.allFinite(); });
  return finite;
}

void require_unit(double metres_per_unit) {
  if (std::isfinite(metres_per_unit) && metres_per_unit > 0.0) return;
  throw Error({.where = "metres_per_unit",
               .found = number_text(metres_per_unit),
               .allowed = "a finite number above 0"});
}

/// The normal of the scaled surface: multiplied by the inverse transpose.
Eigen::Vector3f stretched_normal(const Eigen::Vector3f& normal, const Eigen::Vector3d& factors) {
  const Eigen::Vector3d stretched = normal.cast<double>().cwiseQuotient(factors);
  const double length = stretched.stableNorm();
  return length > 0.0 ? Eigen::Vector3f((stretched / length).cast<float>()) : normal;
}

void stretch_tangent(Eigen::Vector4f& tangent, const Eigen::Vector3d& factors) {
  const Eigen::Vector3d along = tangent.head<3>().cast<double>().cwiseProduct(factors);
  const double length = along.stableNorm();
  if (length > 0.0) tangent.head<3>() = (along / length).cast<float>();
}

/// Of a mirrored mesh: the corners in the opposite order, and the bitangents on the other side.
void reverse_fronts(Mesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Eigen::Vector4f& tangent : mesh.tangents) tangent.w() = -tangent.w();
}

/// Turns, scales and then moves the frames of nodes.
void move_nodes(std::vector<ModelNode>& nodes, const ModelFrame& frame,
                const Eigen::Vector3d& shift_m) {
  for (ModelNode& node : nodes) {
    Eigen::Matrix4d matrix = node.model_from_node.matrix();
    for (int column = 0; column < 4; ++column) {
      Eigen::Vector3d v = matrix.col(column).head<3>();
      if (frame.up) turn(v, *frame.up);
      matrix.col(column).head<3>() = v;
    }
    node.model_from_node.matrix() = matrix;
    node.model_from_node.translation() =
        node.model_from_node.translation() * frame.metres_per_unit.value_or(1.0) + shift_m;
  }
}

}  // namespace

void apply_model_frame(Model& model, const ModelFrame& frame, bool centre) {
  Mesh& mesh = model.mesh;
  const double scale = frame.metres_per_unit.value_or(1.0);
  require_unit(scale);
  if (frame.up && *frame.up != Axis::z) turn_mesh(mesh, *frame.up);
  if (scale != 1.0) {
    for_origins(mesh, [scale](Eigen::Vector3d& origin_m) { origin_m *= scale; });
    for (auto& v : mesh.positions_m) v = (v.cast<double>() * scale).cast<float>();
  }
  if (!is_finite(mesh)) {
    throw Error(
        {.where = "metres_per_unit",
         .found = number_text(scale) + " makes '" + mesh.name + "' too large for single precision",
         .remedy = "use a smaller scale"});
  }
  const Eigen::AlignedBox3d box = bounds(mesh);
  const bool moves = centre && !box.isEmpty();
  const Eigen::Vector3d middle = moves ? box.center() : Eigen::Vector3d::Zero().eval();
  if (moves) for_origins(mesh, [&](Eigen::Vector3d& origin_m) { origin_m -= middle; });
  move_nodes(model.nodes, frame, -middle);
}

Mesh scaled_copy(const Mesh& mesh, const Eigen::Vector3d& factors) {
  Mesh result = mesh;
  for_origins(result,
              [&](Eigen::Vector3d& origin_m) { origin_m = origin_m.cwiseProduct(factors); });
  for (auto& v : result.positions_m) {
    v = v.cast<double>().cwiseProduct(factors).cast<float>().array() + 0.0F;  // never -0
  }
  if (factors.prod() < 0.0) reverse_fronts(result);
  for (auto& n : result.normals) n = stretched_normal(n, factors);
  for (auto& t : result.tangents) stretch_tangent(t, factors);
  if (is_finite(result)) return result;
  throw Error({.where = "scale",
               .found = "it makes '" + mesh.name + "' too large for single precision",
               .remedy = "use smaller factors"});
}

}  // namespace glidar

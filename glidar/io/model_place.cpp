// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model_place.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

template <class V>
void turn(V& v, Axis up) {
  using S = typename V::Scalar;
  const S x = v.x();
  const S y = v.y();
  const S z = v.z();
  if (up == Axis::y) {
    v.y() = -z;
    v.z() = y;
  } else if (up == Axis::x) {
    v.x() = y;
    v.y() = z;
    v.z() = x;
  }
}

}  // namespace

void place_mesh(Mesh& mesh, const ModelOptions& options) {
  const double scale = options.metres_per_unit;
  if (!std::isfinite(scale) || scale <= 0.0) {
    throw Error({.where = "metres_per_unit",
                 .found = number_text(scale),
                 .allowed = "a finite number above 0",
                 .remedy = ""});
  }
  if (options.up && *options.up != Axis::z) {
    turn(mesh.origin_m, *options.up);
    for (auto& v : mesh.positions_m) turn(v, *options.up);
    for (auto& v : mesh.normals) turn(v, *options.up);
    for (auto& v : mesh.tangents) turn(v, *options.up);
  }
  if (scale == 1.0) return;
  mesh.origin_m *= scale;
  for (auto& v : mesh.positions_m) v = (v.cast<double>() * scale).cast<float>();
  const bool in_range = std::all_of(mesh.positions_m.begin(), mesh.positions_m.end(),
                                    [](const Eigen::Vector3f& v) { return v.allFinite(); });
  if (!in_range || !mesh.origin_m.allFinite()) {
    throw Error(
        {.where = "metres_per_unit",
         .found = number_text(scale) + " makes '" + mesh.name + "' too large for single precision",
         .allowed = "",
         .remedy = "use a smaller scale"});
  }
}

}  // namespace glidar

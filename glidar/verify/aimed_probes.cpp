// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/aimed_probes.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/verify/probes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace glidar {
namespace {

constexpr Real kMinCosine = 0.01L;  // of faces that are clearly front or back faces

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The vertices, edges and faces of a placed shape, as seen from the sensor.
class ShapeView {
 public:
  explicit ShapeView(const PlacedShape& placed) : placed_(placed) {
    const std::vector<Triangle>& triangles = placed.shape.mesh.triangles;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const RealVector a = vertex(triangles[t][0]);
      const RealVector normal =
          (vertex(triangles[t][1]) - a).cross(vertex(triangles[t][2]) - a).normalized();
      cosine_.push_back(-normal.dot(a.normalized()));
      normal_.push_back(normal);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = triangles[t][k];
        edges_[std::minmax(from, triangles[t][(k + 1) % 3])].push_back(t);
        around_[from].push_back(t);
      }
    }
  }

  [[nodiscard]] RealVector vertex(std::uint32_t i) const {
    return exact_vertex(placed_.shape.mesh, i, placed_.scale, placed_.pose);
  }
  [[nodiscard]] bool are_visible(const std::vector<std::uint32_t>& triangles) const {
    return std::all_of(triangles.begin(), triangles.end(),
                       [&](std::uint32_t t) { return cosine_[t] > kMinCosine; });
  }
  /// True if the edge of two triangles is part of the silhouette.
  [[nodiscard]] bool is_outline(const std::vector<std::uint32_t>& triangles) const {
    const Real a = cosine_[triangles[0]];
    const Real b = cosine_[triangles[1]];
    return std::max(a, b) > kMinCosine && std::min(a, b) < -kMinCosine;
  }
  [[nodiscard]] RealVector outwards(const std::vector<std::uint32_t>& triangles) const {
    return (normal_[triangles[0]] + normal_[triangles[1]]).normalized();
  }
  [[nodiscard]] const std::map<Edge, std::vector<std::uint32_t>>& edges() const { return edges_; }
  [[nodiscard]] const std::map<std::uint32_t, std::vector<std::uint32_t>>& triangles_at_vertices()
      const {
    return around_;
  }
  [[nodiscard]] RealVector centre() const { return placed_.pose.shift; }

 private:
  const PlacedShape& placed_;
  std::vector<Real> cosine_;  ///< per triangle, towards the sensor
  std::vector<RealVector> normal_;
  std::map<Edge, std::vector<std::uint32_t>> edges_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> around_;  ///< per vertex
};

Eigen::Vector3d direction_to(const AimTarget& at, const RealVector& point) {
  return (at.sensor_from_axes * point.normalized().cast<double>()).normalized();
}

}  // namespace

Beams beams_at_vertices_and_edges(const AimTarget& at) {
  constexpr Real kScale = 1.3L;  // of a vertex, relative to the shape's centre
  const ShapeView view(at.placed);
  std::vector<Eigen::Vector3d> directions;
  for (const auto& [vertex, triangles] : view.triangles_at_vertices()) {
    const RealVector point = view.vertex(vertex);
    if (view.are_visible(triangles)) directions.push_back(direction_to(at, point));
    directions.push_back(direction_to(at, view.centre() + kScale * (point - view.centre())));
  }
  std::uint32_t index = 0;
  for (const auto& [edge, triangles] : view.edges()) {
    if (!view.are_visible(triangles)) continue;
    const std::array<double, 4> u = probe_uniforms(at.number, index++);
    for (const double part : {0.5, u[0], u[1], u[2], u[3]}) {
      const RealVector from = view.vertex(edge.first);
      directions.push_back(
          direction_to(at, from + static_cast<Real>(part) * (view.vertex(edge.second) - from)));
    }
  }
  return unstructured_probes(std::move(directions));
}

Beams beams_beside_outline(const AimTarget& at) {
  const ShapeView view(at.placed);
  std::vector<Eigen::Vector3d> directions;
  std::uint32_t index = 0;
  for (const auto& [edge, triangles] : view.edges()) {
    if (!view.is_outline(triangles)) continue;
    for (int i = 0; i < 16; ++i) {
      const std::array<double, 4> u = probe_uniforms(at.number, index++);
      const RealVector from = view.vertex(edge.first);
      const RealVector point = from + static_cast<Real>(u[0]) * (view.vertex(edge.second) - from);
      const double beside = (u[1] < 0.5 ? -1.0 : 1.0) * portable_pow(10.0, -9.0 + 3.0 * u[2]);
      directions.push_back(direction_to(
          at, point + static_cast<Real>(beside * at.placed.scale) * view.outwards(triangles)));
    }
  }
  return unstructured_probes(std::move(directions));
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/probes.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace glidar {

std::array<double, 4> probe_uniforms(std::uint32_t number, std::uint32_t index) {
  const RandomWords words =
      random_words({.seed = 1, .frame = number, .beam = index, .purpose = Purpose::verification});
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

Eigen::Quaterniond random_rotation(const std::array<double, 4>& u) {
  const double a = std::sqrt(1.0 - u[0]);
  const double b = std::sqrt(u[0]);
  const double s = 2.0 * std::numbers::pi * u[1];
  const double t = 2.0 * std::numbers::pi * u[2];
  return Eigen::Quaterniond(b * portable_cos(t), a * portable_sin(s), a * portable_cos(s),
                            b * portable_sin(t))
      .normalized();
}

Eigen::Vector3d random_direction(double u0, double u1, double half_angle_rad) {
  const double z = 1.0 - u0 * (1.0 - portable_cos(half_angle_rad));
  const double r = std::sqrt(1.0 - z * z);
  const double angle = 2.0 * std::numbers::pi * u1;
  return Eigen::Vector3d(r * portable_cos(angle), r * portable_sin(angle), z).normalized();
}

Beams camera_probes(double half_view_rad) {
  constexpr std::uint32_t kImageSide = 64;
  return make_beams(pinhole_from_fov(kImageSide, kImageSide, 2.0 * half_view_rad));
}

Beams scanner_probes() {
  constexpr std::uint32_t kRows = 32;
  constexpr std::uint32_t kColumns = 1024;
  constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
  Beams beams;
  beams.rows = kRows;
  beams.cols = kColumns;
  beams.frame_id = "verify";
  beams.boresight = Eigen::Vector3d::UnitX();
  for (std::uint32_t row = 0; row < kRows; ++row) {
    const double part = (row + 0.5) / kRows - 0.5;
    const double elevation_rad = 0.5 * part + 1.2 * part * part * part;
    for (std::uint32_t col = 0; col < kColumns; ++col) {
      const double azimuth_rad = kStep_rad * (col + 0.25 * (row % 4));
      const Eigen::Vector3d direction(portable_cos(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(elevation_rad));
      beams.directions.push_back(direction.normalized());
    }
  }
  return beams;
}

Beams unstructured_probes(std::vector<Eigen::Vector3d> directions,
                          std::vector<Eigen::Vector3d> origins_m) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(directions.size());
  beams.frame_id = "verify";
  beams.directions = std::move(directions);
  beams.origins_m = std::move(origins_m);
  return beams;
}

Beams random_probes(std::uint32_t number, double half_view_rad, double spread_m) {
  constexpr std::uint32_t kRandomRays = 4096;
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins_m;
  for (std::uint32_t i = 0; i < kRandomRays; ++i) {
    const std::array<double, 4> u = probe_uniforms(number, 1 + i);
    directions.push_back(random_direction(u[0], u[1], half_view_rad));
    origins_m.emplace_back(spread_m * (u[2] - 0.5), spread_m * (u[3] - 0.5), 0.0);
  }
  return unstructured_probes(std::move(directions), std::move(origins_m));
}

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

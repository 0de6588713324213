// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/silhouettes.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

bool has_corner(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3f& position) {
  const Triangle& t = mesh.triangles[triangle];
  return std::any_of(t.begin(), t.end(),
                     [&](std::uint32_t vertex) { return mesh.positions_m[vertex] == position; });
}

/// The other triangles along an edge of a triangle: their number and the lowest.
struct Others {
  std::size_t count = 0;
  std::uint32_t lowest = MeshEdge::kNone;
};

Others others_along(const Mesh& mesh, const Neighbours& neighbours, std::uint32_t triangle,
                    std::uint32_t from, std::uint32_t to) {
  Others others;
  for (const std::uint32_t t : neighbours.around(from)) {
    if (t == triangle || !has_corner(mesh, t, mesh.positions_m[to])) continue;
    ++others.count;
    others.lowest = std::min(others.lowest, t);
  }
  return others;
}

/// -1: the sensor is behind the triangle, 1: in front of it, 0: in its plane as far as double
/// resolves.
int side_of(const Resolver& resolver, std::uint32_t instance, std::uint32_t triangle) {
  constexpr double kRounding = 0x1p-44;  // see slack()
  const Eigen::Vector3d& sensor = resolver.view(instance).sensor_in_object;
  const TrianglePlane& plane = resolver.plane(instance, triangle);
  const double above = plane.normal.dot(sensor) - plane.offset;
  const double room = kRounding * (sensor.norm() + std::abs(plane.offset));
  if (!(std::abs(above) > room)) return 0;
  return above > 0.0 ? 1 : -1;
}

bool is_silhouette(const Resolver& resolver, std::uint32_t instance, const MeshEdge& edge) {
  if (edge.second == MeshEdge::kNone) return true;
  const int side = side_of(resolver, instance, edge.first);
  return side == 0 || side != side_of(resolver, instance, edge.second);
}

/// The part of a line in front of the sensor, as columns and rows of the picture; pixel centres are
/// at whole numbers.
struct PixelLine {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool is_seen = false;
};

PixelLine project(Eigen::Vector3d from, Eigen::Vector3d to, const PinholeIntrinsics& k) {
  constexpr double kLeastPart = 1e-6;  // of the farther end's depth
  const double least = kLeastPart * std::max(from.z(), to.z());
  if (!(least > 0.0)) return {};
  const auto clip = [&](const Eigen::Vector3d& inner, Eigen::Vector3d& outer) {
    if (outer.z() >= least) return;
    const double part = (inner.z() - least) / (inner.z() - outer.z());
    outer = inner + part * (outer - inner);
    outer.z() = least;
  };
  clip(to, from);
  clip(from, to);
  const auto pixel = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return {k.fx * p.x() / p.z() + k.cx - k.pixel_centre,
            k.fy * p.y() / p.z() + k.cy - k.pixel_centre};
  };
  return {.from = pixel(from), .to = pixel(to), .is_seen = true};
}

/// Calls found(row, column) for the pixel centres of a part within the band around a line.
template <class Found>
void for_pixels_by(const PixelLine& line, double band_px, const PixelRect& part,
                   const Found& found) {
  const Eigen::Vector2d way = line.to - line.from;
  const int along = std::abs(way.x()) >= std::abs(way.y()) ? 0 : 1;
  const int across = 1 - along;
  const Eigen::Vector2d first(part.first_col, part.first_row);
  const Eigen::Vector2d last(part.first_col + part.cols - 1.0, part.first_row + part.rows - 1.0);
  const double low = std::min(line.from[along], line.to[along]) - band_px;
  const double high = std::max(line.from[along], line.to[along]) + band_px;
  const double end = std::min(std::floor(high), last[along]);
  for (double at = std::max(std::ceil(low), first[along]); at <= end; at += 1.0) {
    const double ratio =
        way[along] == 0.0 ? 0.0 : std::clamp((at - line.from[along]) / way[along], 0.0, 1.0);
    const double height = line.from[across] + ratio * way[across];
    const double nearest = std::round(height);
    // At up to 45 degrees the distance is at least 1 / sqrt(2) of that in height.
    if (!(std::abs(height - nearest) <= 1.5 * band_px)) continue;
    if (nearest < first[across] || nearest > last[across]) continue;
    const auto a = static_cast<std::size_t>(at);
    const auto b = static_cast<std::size_t>(nearest);
    along == 0 ? found(b, a) : found(a, b);
  }
}

}  // namespace

std::vector<MeshEdge> mesh_edges(const Mesh& mesh, const Neighbours& neighbours) {
  std::vector<MeshEdge> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k];
      const std::uint32_t to = mesh.triangles[t][(k + 1) % 3];
      if (mesh.positions_m[from] == mesh.positions_m[to]) continue;
      const Others others = others_along(mesh, neighbours, t, from, to);
      if (others.lowest < t) continue;  // it has the edge already
      edges.push_back({from, to, t, others.count == 1 ? others.lowest : MeshEdge::kNone});
    }
  }
  return edges;
}

void SilhouettePixels::add(const CastRequest& request, const Resolver& resolver,
                           std::uint32_t instance, const std::vector<MeshEdge>& edges,
                           const PixelRect& part) {
  const Eigen::Matrix<double, 3, 4> seen = sensor_from_object(resolver.view(instance));
  const std::vector<Eigen::Vector3f>& positions = resolver.mesh(instance).positions_m;
  const auto found = [&](std::size_t row, std::size_t col) {
    pixels_.push_back(row * request.beams.cols + col);
  };
  for (const MeshEdge& edge : edges) {
    if (!is_silhouette(resolver, instance, edge)) continue;
    const PixelLine line =
        project(seen * positions[edge.from].cast<double>().homogeneous(),
                seen * positions[edge.to].cast<double>().homogeneous(), *request.beams.pinhole);
    if (line.is_seen) for_pixels_by(line, band_px_, part, found);
  }
}

const std::vector<std::size_t>& SilhouettePixels::find(
    const CastRequest& request, const Resolver& resolver,
    const std::vector<std::vector<MeshEdge>>& edges, const PixelRect& part) {
  pixels_.clear();
  const std::vector<Instance>& instances = resolver.scene().instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (is_present(request, i)) add(request, resolver, i, edges[instances[i].mesh], part);
  }
  std::sort(pixels_.begin(), pixels_.end());
  pixels_.erase(std::unique(pixels_.begin(), pixels_.end()), pixels_.end());
  return pixels_;
}

}  // namespace glidar

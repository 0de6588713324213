// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/silhouettes.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace glidar {
namespace {

/// One side of a triangle. Half-edges of one edge have equal ends.
struct HalfEdge {
  std::uint32_t low;    ///< position number of an end, see number_positions()
  std::uint32_t high;   ///< that of the other end; not lower
  std::uint32_t index;  ///< 3 * triangle + its first corner

  [[nodiscard]] std::uint32_t triangle() const { return index / 3; }
  [[nodiscard]] bool is_along(const HalfEdge& other) const {
    return low == other.low && high == other.high;
  }
  [[nodiscard]] bool operator<(const HalfEdge& other) const {
    return std::tie(low, high, index) < std::tie(other.low, other.high, other.index);
  }
};

bool is_before(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Numbers the positions of vertices; equal positions have equal numbers.
std::vector<std::uint32_t> number_positions(const std::vector<Eigen::Vector3f>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return is_before(positions[a], positions[b]);
  });
  std::vector<std::uint32_t> number(positions.size());
  std::uint32_t numbers = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || positions[order[i]] != positions[order[i - 1]]) ++numbers;
    number[order[i]] = numbers - 1;
  }
  return number;
}

/// Sorted by edge, then by triangle.
std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
  const std::vector<std::uint32_t> number = number_positions(mesh.positions_m);
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = number[mesh.triangles[t][k]];
      const std::uint32_t to = number[mesh.triangles[t][(k + 1) % 3]];
      if (from != to) half_edges.push_back({std::min(from, to), std::max(from, to), 3 * t + k});
    }
  }
  std::sort(half_edges.begin(), half_edges.end());
  return half_edges;
}

/// -1: the sensor is behind the triangle, 1: in front of it, 0: in its plane within the rounding of
/// double. `distance`: from the mesh's origin to the sensor.
std::int8_t side_of(const TrianglePlane& plane, const Eigen::Vector3d& sensor, double distance) {
  constexpr double kRounding = 0x1p-44;  // 256 roundings
  const double above = plane.normal.dot(sensor) - plane.offset;
  const double margin = kRounding * (distance + std::abs(plane.offset));
  const int side = static_cast<int>(above > margin) - static_cast<int>(above < -margin);
  return static_cast<std::int8_t>(side);
}

bool is_silhouette(const MeshEdge& edge, const std::vector<std::int8_t>& sides) {
  if (edge.second == MeshEdge::kNone) return true;
  const std::int8_t side = sides[edge.first];
  return side == 0 || side != sides[edge.second];
}

/// The part of a line in front of the sensor, as columns and rows of the image; pixel centres have
/// integer coordinates.
struct PixelLine {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool is_visible = false;
};

PixelLine project(Eigen::Vector3d from, Eigen::Vector3d to, const PinholeIntrinsics& k) {
  constexpr double kMinPart = 1e-6;  // of the farther end's depth
  const double min_depth = kMinPart * std::max(from.z(), to.z());
  if (!(min_depth > 0.0)) return {};
  const auto clip = [&](const Eigen::Vector3d& inner, Eigen::Vector3d& outer) {
    if (outer.z() >= min_depth) return;
    const double part = (inner.z() - min_depth) / (inner.z() - outer.z());
    outer = inner + part * (outer - inner);
    outer.z() = min_depth;
  };
  clip(to, from);
  clip(from, to);
  const auto pixel = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return {k.fx * p.x() / p.z() + k.cx - k.pixel_centre,
            k.fy * p.y() / p.z() + k.cy - k.pixel_centre};
  };
  return {.from = pixel(from), .to = pixel(to), .is_visible = true};
}

/// Calls visit(row, column) for the pixel centres of a rectangle within the band around a line.
template <class Visit>
void for_pixels_by(const PixelLine& line, double band_px, const PixelRect& part,
                   const Visit& visit) {
  const Eigen::Vector2d step = line.to - line.from;
  const int along = std::abs(step.x()) >= std::abs(step.y()) ? 0 : 1;
  const int across = 1 - along;
  const Eigen::Vector2d first(part.first_col, part.first_row);
  const Eigen::Vector2d last(part.first_col + part.cols - 1.0, part.first_row + part.rows - 1.0);
  const double low = std::min(line.from[along], line.to[along]) - band_px;
  const double high = std::max(line.from[along], line.to[along]) + band_px;
  const double end = std::min(std::floor(high), last[along]);
  for (double at = std::max(std::ceil(low), first[along]); at <= end; at += 1.0) {
    const double ratio =
        step[along] == 0.0 ? 0.0 : std::clamp((at - line.from[along]) / step[along], 0.0, 1.0);
    const double height = line.from[across] + ratio * step[across];
    const double nearest = std::round(height);
    // At up to 45 degrees the distance is at least 1 / sqrt(2) of the distance along the other
    // axis.
    if (!(std::abs(height - nearest) <= 1.5 * band_px)) continue;
    if (nearest < first[across] || nearest > last[across]) continue;
    const auto a = static_cast<std::size_t>(at);
    const auto b = static_cast<std::size_t>(nearest);
    along == 0 ? visit(b, a) : visit(a, b);
  }
}

/// The edges of an instance as seen by a pinhole camera.
struct EdgeView {
  const std::vector<MeshEdge>& edges;
  const std::vector<std::int8_t>& sides;  ///< see side_of()
  const std::vector<Eigen::Vector3f>& positions;
  Eigen::Matrix<double, 3, 4> sensor_from_object;
  const Beams& beams;
  const PixelRect& part;
  double band_px;

  [[nodiscard]] Eigen::Vector3d point(std::uint32_t vertex) const {
    return sensor_from_object * positions[vertex].cast<double>().homogeneous();
  }

  /// Adds the pixels near silhouettes among the edges [begin, end).
  void add_pixels(std::size_t begin, std::size_t end, std::vector<std::size_t>& pixels) const {
    for (std::size_t i = begin; i < end; ++i) {
      const MeshEdge& edge = edges[i];
      if (!is_silhouette(edge, sides)) continue;
      const PixelLine line = project(point(edge.from), point(edge.to), *beams.pinhole);
      if (!line.is_visible) continue;
      for_pixels_by(line, band_px, part, [&](std::size_t row, std::size_t col) {
        pixels.push_back(row * beams.cols + col);
      });
    }
  }
};

}  // namespace

std::vector<MeshEdge> mesh_edges(const Mesh& mesh) {
  const std::vector<HalfEdge> half_edges = sorted_half_edges(mesh);
  std::vector<MeshEdge> edges;
  for (std::size_t begin = 0, end = 0; begin < half_edges.size(); begin = end) {
    const HalfEdge& first = half_edges[begin];
    while (end < half_edges.size() && half_edges[end].is_along(first)) ++end;
    const bool is_pair = end - begin == 2 && half_edges[begin + 1].triangle() != first.triangle();
    const Triangle& corners = mesh.triangles[first.triangle()];
    const std::uint32_t k = first.index % 3;
    edges.push_back({corners[k], corners[(k + 1) % 3], first.triangle(),
                     is_pair ? half_edges[begin + 1].triangle() : MeshEdge::kNone});
  }
  return edges;
}

void SilhouettePixels::find_sides(const Resolver& resolver, std::uint32_t instance,
                                  ThreadPool& thread_pool) {
  constexpr std::size_t kTrianglesPerTask = 16384;
  const Eigen::Vector3d& sensor = resolver.view(instance).sensor_in_object;
  const double distance = sensor.norm();
  sides_.resize(resolver.mesh(instance).triangles.size());
  thread_pool.parallel_for(
      sides_.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const TrianglePlane plane = resolver.plane(instance, static_cast<std::uint32_t>(i));
          sides_[i] = side_of(plane, sensor, distance);
        }
      });
}

void SilhouettePixels::add(const CastRequest& request, const Resolver& resolver,
                           std::uint32_t instance, const std::vector<MeshEdge>& edges,
                           const PixelRect& part, ThreadPool& thread_pool) {
  constexpr std::size_t kEdgesPerSection = 16384;
  find_sides(resolver, instance, thread_pool);
  const EdgeView view{.edges = edges,
                      .sides = sides_,
                      .positions = resolver.mesh(instance).positions_m,
                      .sensor_from_object = sensor_from_object(resolver.view(instance)),
                      .beams = request.beams,
                      .part = part,
                      .band_px = band_px_};
  const std::size_t count = (edges.size() + kEdgesPerSection - 1) / kEdgesPerSection;
  section_pixels_.resize(std::max(section_pixels_.size(), count));
  thread_pool.parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      section_pixels_[i].clear();
      view.add_pixels(i * kEdgesPerSection, std::min((i + 1) * kEdgesPerSection, edges.size()),
                      section_pixels_[i]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) {
    pixels_.insert(pixels_.end(), section_pixels_[i].begin(), section_pixels_[i].end());
  }
}

const std::vector<std::size_t>& SilhouettePixels::find(
    const CastRequest& request, const Resolver& resolver,
    const std::vector<std::vector<MeshEdge>>& edges, const PixelRect& part,
    ThreadPool& thread_pool) {
  pixels_.clear();
  const std::vector<Instance>& instances = resolver.scene().instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    add(request, resolver, i, edges[instances[i].mesh], part, thread_pool);
  }
  std::sort(pixels_.begin(), pixels_.end());
  pixels_.erase(std::unique(pixels_.begin(), pixels_.end()), pixels_.end());
  return pixels_;
}

}  // namespace glidar

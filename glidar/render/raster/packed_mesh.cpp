// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/packed_mesh.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/planes.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace glidar::raster {
namespace {

constexpr std::size_t kClusterTriangles = kPacketsPerCluster * kLanes;

Eigen::Vector3f corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]];
}

/// A triangle and its centroid.
struct TriangleCentroid {
  Eigen::Vector3f middle;
  std::uint32_t triangle;
};

/// Centroids of the chosen triangles that have a plane.
std::vector<TriangleCentroid> centroids(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  const std::size_t count = chosen.empty() ? mesh.triangles.size() : chosen.size();
  std::vector<TriangleCentroid> all;
  all.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t t = chosen.empty() ? i : chosen[i];
    if (std::isnan(plane_of(mesh, t).normal.x())) continue;
    constexpr float kThird =
        1.0F / 3.0F;  // before the sum, which would overflow for large coordinates
    all.push_back(
        {kThird * corner(mesh, t, 0) + kThird * corner(mesh, t, 1) + kThird * corner(mesh, t, 2),
         t});
  }
  return all;
}

/// Sorts triangles so that neighbours are adjacent: halves across the longest side, recursively,
/// down to clusters and packets.
void sort_spatially(std::span<TriangleCentroid> all) {
  if (all.size() <= kLanes) return;
  Eigen::AlignedBox3f box;
  for (const TriangleCentroid& centroid : all) box.extend(centroid.middle);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t whole = all.size() > kClusterTriangles ? kClusterTriangles : kLanes;
  const std::size_t half = (all.size() + whole - 1) / whole / 2 * whole;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                   [axis](const TriangleCentroid& a, const TriangleCentroid& b) {
                     return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                             : a.triangle < b.triangle;
                   });
  sort_spatially(all.first(half));
  sort_spatially(all.subspan(half));
}

/// Sets the box of one lane and returns its middle.
Eigen::Vector3f set_box(const Mesh& mesh, std::span<const TriangleCentroid> members, unsigned lane,
                        BoxPacket& boxes) {
  Eigen::AlignedBox3f box;
  for (const TriangleCentroid& centroid : members) {
    for (std::size_t k = 0; k < 3; ++k) box.extend(corner(mesh, centroid.triangle, k));
  }
  // Halved before the sum, which would overflow for large coordinates.
  const Eigen::Vector3f middle = 0.5F * box.min() + 0.5F * box.max();
  const Eigen::Vector3f half = (box.max() - middle).cwiseMax(middle - box.min());
  constexpr float kBoxMargin = 1.0F + 4.0F * std::numeric_limits<float>::epsilon();
  boxes.middle.set(lane, middle);
  boxes.half.set(lane, kBoxMargin * half);
  return middle;
}

TrianglePacket pack_triangles(const Mesh& mesh, std::span<const TriangleCentroid> members,
                              const Eigen::Vector3f& middle) {
  TrianglePacket packed;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t triangle =
        members[std::min<std::size_t>(lane, members.size() - 1)].triangle;
    packed.primitive[lane] = triangle;
    packed.corners.c0.set(lane, corner(mesh, triangle, 0) - middle);
    packed.corners.c1.set(lane, corner(mesh, triangle, 1) - middle);
    packed.corners.c2.set(lane, corner(mesh, triangle, 2) - middle);
  }
  return packed;
}

}  // namespace

PackedMesh::PackedMesh(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  std::vector<TriangleCentroid> sorted = centroids(mesh, chosen);
  sort_spatially(sorted);
  const std::span<const TriangleCentroid> all(sorted);
  clusters = (all.size() + kClusterTriangles - 1) / kClusterTriangles;
  packets.reserve((all.size() + kLanes - 1) / kLanes);
  boxes.resize((clusters + kLanes - 1) / kLanes, BoxPacket{});
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    const std::size_t begin = cluster * kClusterTriangles;
    const auto members = all.subspan(begin, std::min(kClusterTriangles, all.size() - begin));
    const Eigen::Vector3f middle =
        set_box(mesh, members, static_cast<unsigned>(cluster % kLanes), boxes[cluster / kLanes]);
    for (std::size_t i = 0; i < members.size(); i += kLanes) {
      packets.push_back(pack_triangles(
          mesh, members.subspan(i, std::min<std::size_t>(kLanes, members.size() - i)), middle));
    }
  }
}

namespace {

// Rounding margins, larger than all errors of single precision here: relative, and in pixels.
constexpr double kBoundMargin = 1e-5;
constexpr double kPixelMargin_px = 0.01;

/// The eight corners of each box, as (column, row, 1) times depth.
struct Corners {
  Lanes3<double> middle;
  std::array<Lanes3<double>, 3> half;  ///< along the box's axes
};

[[gnu::always_inline]] inline void project_boxes(const PixelView& view, const BoxPacket& boxes,
                                                 Corners& corners) {
  const double* m = view.pixel_from_object.data();  // column by column
  for (unsigned i = 0; i < kLanes; ++i) {
    const auto x = static_cast<double>(boxes.middle.x[i]);
    const auto y = static_cast<double>(boxes.middle.y[i]);
    const auto z = static_cast<double>(boxes.middle.z[i]);
    corners.middle.x[i] = m[0] * x + m[3] * y + m[6] * z + m[9];
    corners.middle.y[i] = m[1] * x + m[4] * y + m[7] * z + m[10];
    corners.middle.z[i] = m[2] * x + m[5] * y + m[8] * z + m[11];
  }
  const std::array<const Lanes<float>*, 3> sizes = {&boxes.half.x, &boxes.half.y, &boxes.half.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* along = m + 3 * axis;
    for (unsigned i = 0; i < kLanes; ++i) {
      const auto size = static_cast<double>((*sizes[axis])[i]);
      corners.half[axis].x[i] = along[0] * size;
      corners.half[axis].y[i] = along[1] * size;
      corners.half[axis].z[i] = along[2] * size;
    }
  }
}

/// Bounds of the projected corners.
struct Span {
  Lanes<double> left;
  Lanes<double> right;
  Lanes<double> top;
  Lanes<double> bottom;
  Lanes<double> near;  ///< depths
  Lanes<double> far;
};

[[gnu::always_inline]] inline void extend(const Corners& corners, const std::array<double, 3>& sign,
                                          Span& span) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double x = corners.middle.x[i] + sign[0] * corners.half[0].x[i] +
                     sign[1] * corners.half[1].x[i] + sign[2] * corners.half[2].x[i];
    const double y = corners.middle.y[i] + sign[0] * corners.half[0].y[i] +
                     sign[1] * corners.half[1].y[i] + sign[2] * corners.half[2].y[i];
    const double z = corners.middle.z[i] + sign[0] * corners.half[0].z[i] +
                     sign[1] * corners.half[1].z[i] + sign[2] * corners.half[2].z[i];
    const double col = x / z;
    const double row = y / z;
    span.left[i] = col < span.left[i] ? col : span.left[i];
    span.right[i] = col > span.right[i] ? col : span.right[i];
    span.top[i] = row < span.top[i] ? row : span.top[i];
    span.bottom[i] = row > span.bottom[i] ? row : span.bottom[i];
    span.near[i] = z < span.near[i] ? z : span.near[i];
    span.far[i] = z > span.far[i] ? z : span.far[i];
  }
}

/// The smallest integer from `low` on, and the largest up to `high`, clamped.
[[gnu::always_inline]] inline std::int32_t first_from(double low, double first, double last) {
  const double clamped = low < first ? first : (low > last + 1.0 ? last + 1.0 : low);
  const auto whole = static_cast<std::int32_t>(clamped);
  return whole + static_cast<std::int32_t>(static_cast<double>(whole) < clamped);
}
[[gnu::always_inline]] inline std::int32_t last_to(double high, double first, double last) {
  const double clamped = high > last ? last : (high < first - 1.0 ? first - 1.0 : high);
  const auto whole = static_cast<std::int32_t>(clamped);
  return whole - static_cast<std::int32_t>(static_cast<double>(whole) > clamped);
}

}  // namespace

PixelView pixel_view(const InstanceView& view, const PinholeIntrinsics& k) {
  const Eigen::Matrix<double, 3, 4> sensor_matrix = sensor_from_object(view);
  PixelView result{.pixel_from_object = sensor_matrix};
  // Beams have integer pixel coordinates.
  result.pixel_from_object.row(0) =
      k.fx * sensor_matrix.row(0) + (k.cx - k.pixel_centre) * sensor_matrix.row(2);
  result.pixel_from_object.row(1) =
      k.fy * sensor_matrix.row(1) + (k.cy - k.pixel_centre) * sensor_matrix.row(2);
  return result;
}

GLIDAR_SIMD void bound_clusters(const PixelView& view, const Nearness& nearness,
                                const GridWindow& window, const BoxPacket& boxes,
                                ClusterBounds& bounds) {
  Corners corners;
  project_boxes(view, boxes, corners);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Span span;
  for (unsigned i = 0; i < kLanes; ++i) {
    span.left[i] = span.top[i] = span.near[i] = kFar;
    span.right[i] = span.bottom[i] = span.far[i] = -kFar;
  }
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      for (const double c : {-1.0, 1.0}) extend(corners, {a, b, c}, span);
    }
  }
  const double first_col = window.first_col;
  const double last_col = static_cast<double>(window.end_col) - 1.0;
  const double first_row = window.first_row;
  const double last_row = static_cast<double>(window.end_row) - 1.0;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double near = span.near[i];
    const bool is_ahead = span.far[i] > 0.0;
    const bool is_around =
        near <= kBoundMargin * span.far[i];  // or behind: then it may cover everything
    const double left = is_around ? first_col : span.left[i] - kPixelMargin_px;
    const double right = is_around ? last_col : span.right[i] + kPixelMargin_px;
    const double top = is_around ? first_row : span.top[i] - kPixelMargin_px;
    const double bottom = is_around ? last_row : span.bottom[i] + kPixelMargin_px;
    bounds.left[i] = first_from(left, first_col, last_col);
    bounds.right[i] = is_ahead ? last_to(right, first_col, last_col) : -1;
    bounds.top[i] = first_from(top, first_row, last_row);
    bounds.bottom[i] = is_ahead ? last_to(bottom, first_row, last_row) : -1;
    const double depth = is_around ? 1.0 : near;
    const double closest = nearness.factor * (nearness.far_m - depth) / depth;
    const double bound = closest * (1.0 + kBoundMargin) + kBoundMargin * nearness.factor;
    bounds.nearness[i] = static_cast<float>(is_around ? kFar : bound);
  }
}

bool is_outside(const PixelView& view, const BoxPacket& boxes, unsigned lane,
                const PixelBounds& pixels) {
  using Row = Eigen::Matrix<double, 1, 4>;
  const Eigen::Matrix<double, 3, 4>& pixel = view.pixel_from_object;
  const Eigen::Vector3d middle = boxes.middle.get(lane).cast<double>();
  const Eigen::Vector3d half = boxes.half.get(lane).cast<double>();
  // Linear, and not negative where visible, so some point of the box must reach 0.
  const auto is_beyond = [&](const Row& inside) {
    const double size = inside.head<3>().cwiseAbs().dot(half);
    const double max_value = inside.head<3>().dot(middle) + inside[3] + size;
    return max_value < -kBoundMargin * (size + std::abs(inside[3]));
  };
  return is_beyond(pixel.row(0) - (pixels.left - kPixelMargin_px) * pixel.row(2)) ||
         is_beyond((pixels.right + kPixelMargin_px) * pixel.row(2) - pixel.row(0)) ||
         is_beyond(pixel.row(1) - (pixels.top - kPixelMargin_px) * pixel.row(2)) ||
         is_beyond((pixels.bottom + kPixelMargin_px) * pixel.row(2) - pixel.row(1));
}

void add_visible_clusters(const PixelView& view, const Nearness& nearness, const GridWindow& window,
                          const PackedMesh& mesh, const ClusterRange& range,
                          std::vector<VisibleCluster>& clusters) {
  const PixelBounds all{.left = static_cast<int>(window.first_col),
                        .right = static_cast<int>(window.end_col) - 1,
                        .top = static_cast<int>(window.first_row),
                        .bottom = static_cast<int>(window.end_row) - 1};
  ClusterBounds bounds;
  for (std::uint32_t cluster = range.first; cluster < range.end; ++cluster) {
    const unsigned lane = cluster % kLanes;
    if (lane == 0) bound_clusters(view, nearness, window, mesh.boxes[cluster / kLanes], bounds);
    if (bounds.left[lane] > bounds.right[lane] || bounds.top[lane] > bounds.bottom[lane]) continue;
    if (std::isinf(bounds.nearness[lane]) &&
        is_outside(view, mesh.boxes[cluster / kLanes], lane, all)) {
      continue;
    }
    clusters.push_back({.instance = range.instance,
                        .cluster = cluster,
                        .left = bounds.left[lane],
                        .right = bounds.right[lane],
                        .top = bounds.top[lane],
                        .bottom = bounds.bottom[lane],
                        .nearness = bounds.nearness[lane]});
  }
}

}  // namespace glidar::raster

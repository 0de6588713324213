// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/visible_depths.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

using Planes = Eigen::Matrix<double, 5, 4>;

constexpr int kBorders = 4;
constexpr int kDepth = 4;  // the row that gives the depth

/// Rows 0 to 3: signed distance of a point of the mesh inside each border of the view; borders are
/// the outer edges of the image's pixels. Row 4: its depth.
Planes view_planes(const InstanceView& view, const PinholeIntrinsics& k) {
  const Eigen::Matrix<double, 3, 4> sensor_matrix = sensor_from_object(view);
  const double half = 0.5;
  const double left = (k.pixel_centre - half - k.cx) / k.fx;
  const double right = (k.width - 1 + k.pixel_centre + half - k.cx) / k.fx;
  const double top = (k.pixel_centre - half - k.cy) / k.fy;
  const double bottom = (k.height - 1 + k.pixel_centre + half - k.cy) / k.fy;
  Planes planes;
  planes << sensor_matrix.row(0) - left * sensor_matrix.row(2),
      right * sensor_matrix.row(2) - sensor_matrix.row(0),
      sensor_matrix.row(1) - top * sensor_matrix.row(2),
      bottom * sensor_matrix.row(2) - sensor_matrix.row(1), sensor_matrix.row(2);
  return planes;
}

using Values = Eigen::Matrix<double, 5, 1>;

Values values_at(const Planes& planes, const Eigen::Vector3f& position) {
  return planes * position.cast<double>().homogeneous();
}

std::uint8_t borders_beyond(const Values& values) {
  std::uint8_t bits = 0;
  for (int b = 0; b < kBorders; ++b) {
    bits = static_cast<std::uint8_t>(bits | (values[b] < 0.0 ? 1U << b : 0U));
  }
  return bits;
}

/// A convex polygon: three corners, and one more for every border that clips it.
struct Polygon {
  std::array<Values, 3 + kBorders> corners;
  int count = 0;
};

/// Sutherland and Hodgman, "Reentrant polygon clipping" (1974), at one border.
Polygon clip(const Polygon& polygon, int border) {
  Polygon inside;
  for (int i = 0; i < polygon.count; ++i) {
    const Values& a = polygon.corners[static_cast<std::size_t>(i)];
    const Values& b = polygon.corners[static_cast<std::size_t>((i + 1) % polygon.count)];
    const bool a_in = a[border] >= 0.0;
    const bool b_in = b[border] >= 0.0;
    if (a_in) inside.corners[static_cast<std::size_t>(inside.count++)] = a;
    if (a_in == b_in) continue;
    const double part = a[border] / (a[border] - b[border]);
    inside.corners[static_cast<std::size_t>(inside.count++)] = a + part * (b - a);
  }
  return inside;
}

/// Depths of the part of a triangle that is in view.
DepthSpan depths_of(const Planes& planes, const Mesh& mesh, const Triangle& triangle) {
  Polygon polygon{.corners = {}, .count = 3};
  for (std::size_t k = 0; k < 3; ++k) {
    polygon.corners[k] = values_at(planes, mesh.positions_m[triangle[k]]);
  }
  for (int border = 0; border < kBorders && polygon.count > 0; ++border) {
    polygon = clip(polygon, border);
  }
  DepthSpan span;
  for (int i = 0; i < polygon.count; ++i) {
    span.extend(polygon.corners[static_cast<std::size_t>(i)][kDepth]);
  }
  return span;
}

/// Calls work(begin, end) on sections of [0, count), and joins the returned spans.
template <class Body>
DepthSpan join_spans(std::size_t count, ThreadPool& thread_pool, std::vector<DepthSpan>& spans,
                     const Body& body) {
  constexpr std::size_t kDepthsPerSection = 16384;
  const std::size_t sections = (count + kDepthsPerSection - 1) / kDepthsPerSection;
  spans.assign(sections, {});
  thread_pool.parallel_for(sections, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      spans[i] = body(i * kDepthsPerSection, std::min(count, (i + 1) * kDepthsPerSection));
    }
  });
  DepthSpan all;
  for (const DepthSpan& span : spans) all.extend(span);
  return all;
}

}  // namespace

DepthSpan VisibleDepths::of(const InstanceView& view, const Mesh& mesh, const PinholeIntrinsics& k,
                            ThreadPool& thread_pool) {
  const Planes planes = view_planes(view, k);
  outside_.resize(mesh.positions_m.size());
  // Vertices that no triangle uses count too; loaders remove them.
  DepthSpan span =
      join_spans(outside_.size(), thread_pool, spans_, [&](std::size_t i, std::size_t end) {
        DepthSpan inside;
        for (; i < end; ++i) {
          const Values values = values_at(planes, mesh.positions_m[i]);
          outside_[i] = borders_beyond(values);
          if (outside_[i] == 0) inside.extend(values[kDepth]);
        }
        return inside;
      });
  span.extend(
      join_spans(mesh.triangles.size(), thread_pool, spans_, [&](std::size_t i, std::size_t end) {
        DepthSpan inside;
        for (; i < end; ++i) {
          const Triangle& t = mesh.triangles[i];
          const bool reaches_out = (outside_[t[0]] | outside_[t[1]] | outside_[t[2]]) != 0;
          const bool is_beyond_one = (outside_[t[0]] & outside_[t[1]] & outside_[t[2]]) != 0;
          if (reaches_out && !is_beyond_one) inside.extend(depths_of(planes, mesh, t));
        }
        return inside;
      }));
  return span;
}

}  // namespace glidar

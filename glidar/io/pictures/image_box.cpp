// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/image_box.hpp>

#include <array>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr double kNearest_m = 1e-3;  ///< near plane

/// Points p with normal.dot(p) >= offset are on the side that is kept.
struct Plane {
  Eigen::Vector3d normal;
  double offset = 0.0;

  [[nodiscard]] double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

/// The planes through the camera and the centres of the image's outermost pixels.
std::array<Plane, 4> sides_of(const RectifiedCamera& camera) {
  return {{{{camera.fx, 0.0, camera.cx}},
           {{-camera.fx, 0.0, camera.width - 1.0 - camera.cx}},
           {{0.0, camera.fy, camera.cy}},
           {{0.0, -camera.fy, camera.height - 1.0 - camera.cy}}}};
}

/// Vertices of a convex polygon, and a buffer for the clipped one.
struct Polygon {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3d> next;
};

/// Clips the polygon at a plane (Sutherland and Hodgman 1974).
void clip(Polygon& polygon, const Plane& plane) {
  polygon.next.clear();
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const Eigen::Vector3d& a = polygon.corners[i];
    const Eigen::Vector3d& b = polygon.corners[(i + 1) % polygon.corners.size()];
    const double above_a = plane.height(a);
    const double above_b = plane.height(b);
    if (above_a >= 0.0) polygon.next.push_back(a);
    if ((above_a >= 0.0) != (above_b >= 0.0))
      polygon.next.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  std::swap(polygon.corners, polygon.next);
}

void extend(Eigen::AlignedBox2d& box, const Polygon& polygon, const RectifiedCamera& camera) {
  for (const Eigen::Vector3d& p : polygon.corners) {
    box.extend(Eigen::Vector2d(camera.fx * p.x() / p.z() + camera.cx,
                               camera.fy * p.y() / p.z() + camera.cy));
  }
}

/// The fraction of a box that an inner box does not cover; for a flat box, of its length.
double share_outside(const Eigen::AlignedBox2d& whole, const Eigen::AlignedBox2d& inside) {
  double covered = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double length = whole.sizes()[axis];
    if (length > 0.0) covered *= inside.sizes()[axis] / length;
  }
  return 1.0 - covered;
}

}  // namespace

std::optional<ImageBox> image_box(const PlacedMesh& placed, const RectifiedCamera& camera) {
  const Plane front{Eigen::Vector3d::UnitZ(), kNearest_m};
  const std::array<Plane, 4> sides = sides_of(camera);
  Eigen::AlignedBox2d whole;
  Eigen::AlignedBox2d inside;
  Polygon polygon;
  for (const Triangle& triangle : placed.mesh.triangles) {
    polygon.corners.clear();
    for (const std::uint32_t corner : triangle) polygon.corners.push_back(placed.in_camera(corner));
    clip(polygon, front);
    extend(whole, polygon, camera);
    for (const Plane& side : sides) clip(polygon, side);
    extend(inside, polygon, camera);
  }
  if (inside.isEmpty()) return std::nullopt;
  // clipped vertices may be outside by rounding
  const Eigen::Vector2d last(camera.width - 1.0, camera.height - 1.0);
  inside.min() = inside.min().cwiseMax(0.0).cwiseMin(last);
  inside.max() = inside.max().cwiseMax(0.0).cwiseMin(last);
  return ImageBox{inside, share_outside(whole, inside)};
}

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/polygons.hpp>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace glidar::import {
namespace {

using Point = Eigen::Vector2d;
using Corners = std::array<std::uint32_t, 3>;  ///< of a polygon

/// Newell's normal, not normalised (Sutherland et al., "A characterization of ten hidden-surface
/// algorithms", 1974).
Eigen::Vector3d normal_of(const SourceMesh& mesh, std::span<const std::uint32_t> face) {
  const Eigen::Vector3d& first = mesh.positions[face[0]];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < face.size(); ++i) {
    const Eigen::Vector3d before = mesh.positions[face[i - 1]] - first;
    normal += before.cross(mesh.positions[face[i]] - first);
  }
  return normal;
}

/// The corners in the coordinate plane most parallel to the polygon, counter-clockwise, relative to
/// the first one.
std::vector<Point> projected(const SourceMesh& mesh, std::span<const std::uint32_t> face) {
  const Eigen::Vector3d normal = normal_of(mesh, face);
  Eigen::Index dropped = 2;
  for (const Eigen::Index axis : {1, 0}) {
    if (std::abs(normal[axis]) > std::abs(normal[dropped])) dropped = axis;
  }
  Eigen::Index right = (dropped + 1) % 3;
  Eigen::Index up = (dropped + 2) % 3;
  if (normal[dropped] < 0.0) std::swap(right, up);
  std::vector<Point> points;
  points.reserve(face.size());
  for (const std::uint32_t vertex : face) {
    const Eigen::Vector3d corner = mesh.positions[vertex] - mesh.positions[face[0]];
    points.emplace_back(corner[right], corner[up]);
  }
  return points;
}

/// Clips ears (Meisters, "Polygons have ears", 1975), in the order of the corners.
class EarClipper {
 public:
  /// Takes from `steps_left` one step for each corner that is tried, and for each comparison with
  /// it.
  EarClipper(std::vector<Point> points, std::uint64_t& steps_left)
      : points_(std::move(points)),
        before_(points_.size()),
        after_(points_.size()),
        steps_left_(steps_left) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      before_[i] = (i + count - 1) % count;
      after_[i] = (i + 1) % count;
    }
    is_convex_ = is_convex();
  }

  /// Appends the triangles. False if no ear is left: the polygon intersects itself.
  bool clip(std::vector<Corners>& triangles) {
    std::uint32_t corner = 0;
    std::size_t left = points_.size();
    for (std::size_t failed = 0; left > 3 && failed < 2 * left;) {
      const std::uint32_t next = after_[corner];
      if (is_ear(corner, failed < left)) {
        triangles.push_back({before_[corner], corner, next});
        cut(corner);
        --left;
        failed = 0;
      } else {
        ++failed;
      }
      corner = next;
    }
    if (left > 3) return false;
    Corners last = {before_[corner], corner, after_[corner]};
    std::sort(last.begin(), last.end());
    triangles.push_back(last);
    return true;
  }

 private:
  void cut(std::uint32_t corner) {
    after_[before_[corner]] = after_[corner];
    before_[after_[corner]] = before_[corner];
    before_[corner] = after_[corner] = corner;
  }

  /// True if no corner is reflex and the polygon goes to the right once: no corner obstructs an
  /// ear.
  [[nodiscard]] bool is_convex() const {
    const auto count = static_cast<std::uint32_t>(points_.size());
    const auto goes_right = [&](std::uint32_t i) {
      return points_[i].x() < points_[after_[i]].x() ||
             (points_[i].x() == points_[after_[i]].x() && points_[i].y() < points_[after_[i]].y());
    };
    std::size_t turns = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (is_reflex(i) || points_[i] == points_[after_[i]]) return false;
      turns += goes_right(i) && !goes_right(after_[i]) ? 1 : 0;
    }
    return turns == 1;
  }

  /// A straight corner is an ear without area, so that polygons beside it share its vertex.
  /// `is_strict`: no reflex corner may touch the ear. The second pass is not strict, for seams and
  /// repeated corners.
  [[nodiscard]] bool is_ear(std::uint32_t corner, bool is_strict) {
    const Corners ear = {before_[corner], corner, after_[corner]};
    const double area = turn(ear[0], ear[1], ear[2]);
    take_step();
    if (area < 0.0) return false;
    if (is_convex_) return true;
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t other = 0; other < count; ++other) {
      take_step();
      if (obstructs(other, ear, is_strict && area > 0.0)) return false;
    }
    return true;
  }

  [[nodiscard]] bool obstructs(std::uint32_t other, const Corners& ear, bool is_strict) const {
    const double nearest = std::min(
        {turn(ear[0], ear[1], other), turn(ear[1], ear[2], other), turn(ear[2], ear[0], other)});
    if (nearest > 0.0) return true;
    return is_strict && nearest == 0.0 && is_reflex(other) && !is_at(other, ear);
  }

  void take_step() {
    if (steps_left_-- > 0) return;
    throw Refusal{"its polygons have so many corners that splitting them takes too long",
                  "split its faces into triangles in the program that made it"};
  }

  [[nodiscard]] bool is_reflex(std::uint32_t corner) const {
    return turn(before_[corner], corner, after_[corner]) < 0.0;
  }

  [[nodiscard]] bool is_at(std::uint32_t corner, const Corners& corners) const {
    return std::any_of(corners.begin(), corners.end(),
                       [&](std::uint32_t other) { return points_[corner] == points_[other]; });
  }

  /// Twice the area, positive if the corners are counter-clockwise.
  [[nodiscard]] double turn(std::uint32_t from, std::uint32_t at, std::uint32_t to) const {
    const Point a = points_[at] - points_[from];
    const Point b = points_[to] - points_[from];
    return a.x() * b.y() - a.y() * b.x();
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> before_;  ///< among the corners that are left; itself: cut
  std::vector<std::uint32_t> after_;
  std::uint64_t& steps_left_;
  bool is_convex_ = false;
};

/// The corner of a quadrilateral where its diagonal begins: a concave one, else the first. There
/// the angles to both neighbours, measured from the diagonal, exceed pi together.
std::size_t first_corner(const SourceMesh& mesh, std::span<const std::uint32_t> quad) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d& at = mesh.positions[quad[i]];
    const Eigen::Vector3d left = mesh.positions[quad[(i + 3) % 4]] - at;
    const Eigen::Vector3d diagonal = mesh.positions[quad[(i + 2) % 4]] - at;
    const Eigen::Vector3d right = mesh.positions[quad[(i + 1) % 4]] - at;
    // acos(a) + acos(b) > pi if a + b < 0.
    if (left.normalized().dot(diagonal) + right.normalized().dot(diagonal) < 0.0) return i;
  }
  return 0;
}

/// False if the polygon intersects itself.
bool split(SourceMesh& mesh, std::span<const std::uint32_t> corners, std::uint64_t& steps_left) {
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return true;
  }
  if (corners.size() == 4) {
    const std::size_t first = first_corner(mesh, corners);
    const auto at = [&](std::size_t i) { return corners[(first + i) % 4]; };
    mesh.triangles.push_back({at(0), at(1), at(2)});
    mesh.triangles.push_back({at(0), at(2), at(3)});
    return true;
  }
  std::vector<Corners> ears;
  const bool is_whole = EarClipper(projected(mesh, corners), steps_left).clip(ears);
  for (const Corners& ear : ears) {
    mesh.triangles.push_back({corners[ear[0]], corners[ear[1]], corners[ear[2]]});
  }
  return is_whole;
}

}  // namespace

void PolygonSplitter::add(SourceMesh& mesh, std::span<const std::uint32_t> corners) {
  constexpr std::uint64_t kSteps = 50;  // for each corner
  const std::size_t before = mesh.triangles.size();
  if (corners.size() > 3 && mesh.first_of_face.empty()) {
    mesh.first_of_face.resize(before);
    std::iota(mesh.first_of_face.begin(), mesh.first_of_face.end(), std::uint32_t{0});
  }
  if (corners.size() > 3 || !mesh.first_of_face.empty()) {
    mesh.first_of_face.push_back(static_cast<std::uint32_t>(before));
  }
  if (corners.size() > 4) steps_left_ += kSteps * corners.size();
  if (!split(mesh, corners, steps_left_)) ++intersecting_;
}

void PolygonSplitter::note_intersecting(SourceModel& source) const {
  if (intersecting_ == 0) return;
  source.notes.add(fmt::format(
      "polygons that intersect themselves, parts of which are left out: {}", intersecting_));
}

}  // namespace glidar::import

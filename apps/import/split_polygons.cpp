// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/split_polygons.hpp>

#include <assimp/scene.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace glidar::import {
namespace {

using Point = Eigen::Vector2d;
using Triangle = std::array<unsigned, 3>;  ///< corners of a polygon

constexpr unsigned kMaxCorners = 4;  // Assimp splits up to these

Eigen::Vector3d position(const aiMesh& mesh, unsigned vertex) {
  const aiVector3D& v = mesh.mVertices[vertex];
  return {v.x, v.y, v.z};
}

/// Newell's normal, not normalised (Sutherland et al., "A characterization of ten hidden-surface
/// algorithms", 1974).
Eigen::Vector3d normal_of(const aiMesh& mesh, const aiFace& face) {
  const Eigen::Vector3d first = position(mesh, face.mIndices[0]);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (unsigned i = 2; i < face.mNumIndices; ++i) {
    const Eigen::Vector3d before = position(mesh, face.mIndices[i - 1]) - first;
    normal += before.cross(position(mesh, face.mIndices[i]) - first);
  }
  return normal;
}

/// The corners in the coordinate plane most parallel to the polygon, counter-clockwise.
std::vector<Point> projected(const aiMesh& mesh, const aiFace& face) {
  const Eigen::Vector3d normal = normal_of(mesh, face);
  Eigen::Index dropped = 2;
  for (const Eigen::Index axis : {1, 0}) {
    if (std::abs(normal[axis]) > std::abs(normal[dropped])) dropped = axis;
  }
  Eigen::Index right = (dropped + 1) % 3;
  Eigen::Index up = (dropped + 2) % 3;
  if (normal[dropped] < 0.0) std::swap(right, up);
  std::vector<Point> points;
  points.reserve(face.mNumIndices);
  for (unsigned i = 0; i < face.mNumIndices; ++i) {
    const Eigen::Vector3d corner = position(mesh, face.mIndices[i]);
    points.emplace_back(corner[right], corner[up]);
  }
  return points;
}

/// Clips ears (Meisters, "Polygons have ears", 1975), in the order of the corners.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points)
      : points_(std::move(points)), before_(points_.size()), after_(points_.size()) {
    const auto count = static_cast<unsigned>(points_.size());
    for (unsigned i = 0; i < count; ++i) {
      before_[i] = (i + count - 1) % count;
      after_[i] = (i + 1) % count;
    }
  }

  /// Appends the triangles. False if no ear is left: the polygon intersects itself.
  bool clip(std::vector<Triangle>& triangles) {
    unsigned corner = 0;
    std::size_t left = points_.size();
    for (std::size_t failed = 0; left > 3 && failed < 2 * left;) {
      const unsigned next = after_[corner];
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
    Triangle last = {before_[corner], corner, after_[corner]};
    std::sort(last.begin(), last.end());
    triangles.push_back(last);
    return true;
  }

 private:
  void cut(unsigned corner) {
    after_[before_[corner]] = after_[corner];
    before_[after_[corner]] = before_[corner];
    before_[corner] = after_[corner] = corner;
  }

  /// A straight corner is an ear without area, so that polygons beside it share its vertex.
  /// `is_strict`: no reflex corner may touch the ear. Seams and repeated corners need less.
  [[nodiscard]] bool is_ear(unsigned corner, bool is_strict) const {
    const Triangle ear = {before_[corner], corner, after_[corner]};
    const double area = turn(ear[0], ear[1], ear[2]);
    if (area < 0.0) return false;
    const auto count = static_cast<unsigned>(points_.size());
    for (unsigned other = 0; other < count; ++other) {
      const double nearest = std::min(
          {turn(ear[0], ear[1], other), turn(ear[1], ear[2], other), turn(ear[2], ear[0], other)});
      if (nearest > 0.0) return false;
      if (is_strict && nearest == 0.0 && area > 0.0 && is_reflex(other) && !is_at(other, ear)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool is_reflex(unsigned corner) const {
    return turn(before_[corner], corner, after_[corner]) < 0.0;
  }

  [[nodiscard]] bool is_at(unsigned corner, const Triangle& corners) const {
    return std::any_of(corners.begin(), corners.end(),
                       [&](unsigned other) { return points_[corner] == points_[other]; });
  }

  /// Twice the area, positive if the corners are counter-clockwise.
  [[nodiscard]] double turn(unsigned from, unsigned at, unsigned to) const {
    const Point a = points_[at] - points_[from];
    const Point b = points_[to] - points_[from];
    return a.x() * b.y() - a.y() * b.x();
  }

  std::vector<Point> points_;
  std::vector<unsigned> before_;  ///< among the corners that are left; itself: cut
  std::vector<unsigned> after_;
};

void set_triangle(aiFace& face, const unsigned* vertices, const Triangle& corners) {
  face.mNumIndices = 3;
  face.mIndices = new unsigned[3];  // the face deletes it
  for (std::size_t i = 0; i < 3; ++i) face.mIndices[i] = vertices[corners[i]];
}

bool has_polygons(const aiMesh& mesh, unsigned max_corners) {
  return std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                     [&](const aiFace& face) { return face.mNumIndices > max_corners; });
}

/// What Assimp does after its own splitting, and leaves out in a mesh without quadrilaterals: two
/// triangles in succession begin with different vertices.
void finish_triangles(aiMesh& mesh) {
  mesh.mPrimitiveTypes &= ~static_cast<unsigned>(aiPrimitiveType_POLYGON);
  mesh.mPrimitiveTypes |= aiPrimitiveType_TRIANGLE;
  unsigned last = mesh.mNumVertices;  // no vertex
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;
    if (face.mIndices[0] == last) std::rotate(face.mIndices, face.mIndices + 2, face.mIndices + 3);
    last = face.mIndices[0];
  }
}

/// Returns the number of polygons that intersect themselves.
std::size_t split(aiMesh& mesh) {
  std::vector<Triangle> triangles;
  std::vector<std::size_t> ends;  // of the triangles of each face
  std::size_t intersecting = 0;
  std::size_t whole = 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices <= kMaxCorners) {
      ++whole;
    } else if (!EarClipper(projected(mesh, face)).clip(triangles)) {
      ++intersecting;
    }
    ends.push_back(triangles.size());
  }
  auto* const faces = new aiFace[whole + triangles.size()];  // the mesh deletes them
  aiFace* to = faces;
  std::size_t next = 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    aiFace& face = mesh.mFaces[i];
    for (; next < ends[i]; ++next) set_triangle(*to++, face.mIndices, triangles[next]);
    if (face.mNumIndices > kMaxCorners) continue;
    std::swap(to->mNumIndices, face.mNumIndices);
    std::swap((to++)->mIndices, face.mIndices);
  }
  delete[] mesh.mFaces;
  mesh.mFaces = faces;
  mesh.mNumFaces = static_cast<unsigned>(to - faces);
  return intersecting;
}

}  // namespace

std::size_t split_polygons(aiScene& scene) {
  std::size_t intersecting = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    aiMesh& mesh = *scene.mMeshes[i];
    if (!has_polygons(mesh, kMaxCorners)) continue;
    intersecting += split(mesh);
    if (!has_polygons(mesh, 3)) finish_triangles(mesh);
  }
  return intersecting;
}

}  // namespace glidar::import

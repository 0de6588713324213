// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar::import {

/// Splits the faces of a model into triangles: quadrilaterals at their concave corner, others by
/// clipping ears.
class PolygonSplitter {
 public:
  /// Appends a face with these corners (vertices, at least three) to the triangles of the mesh. Of
  /// a polygon that intersects itself, parts are left out. Throws Refusal when the polygons of the
  /// model need too many steps: the time can grow by the square of their corners.
  void add(SourceMesh& mesh, std::span<const std::uint32_t> corners);
  /// Adds a note if polygons intersected themselves.
  void note_intersecting(SourceModel& source) const;

 private:
  std::size_t intersecting_ = 0;
  std::uint64_t steps_left_ = 200'000'000;  // about a second; each corner adds more
};

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/work_count.hpp>
#include <glidar/render/opengl/settle.hpp>
#include <glidar/render/opengl/triangle_drawing.hpp>
#include <glidar/render/plane_points.hpp>

#include <cstdint>
#include <span>

namespace glidar::opengl {

/// What turns one part of a picture of triangle numbers into hits.
struct RowWriting {
  const CastRequest& request;
  const Resolver& resolver;
  const Settler& settler;
  const TriangleDrawing& drawing;
  const PlanePoints& points;
  PixelRect rect;
  std::span<const std::uint32_t> numbers;  ///< of the rect's pixels, row by row
  Hits& hits;
};

/// Writes the hits of all its beams and tells the request of them, sharing rows out among threads.
void write_rows(const RowWriting& writing, Workers& workers, WorkCount& count);

}  // namespace glidar::opengl

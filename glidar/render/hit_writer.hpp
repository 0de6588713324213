// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/depth_range.hpp>
#include <glidar/render/overlaps.hpp>
#include <glidar/render/plane_points.hpp>
#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <span>

namespace glidar {

/// Inputs for converting a visibility buffer (triangle ids per pixel), or a tile of one, into hits.
struct HitWriter {
  const CastRequest& request;
  const Resolver& resolver;
  const TriangleIds& triangles;
  const PlanePoints& points;
  PixelRect drawn;                              ///< the pixels that triangle_ids contains
  std::span<const std::uint32_t> triangle_ids;  ///< of `drawn`, row by row
  PixelRect written;                            ///< those of `drawn` whose hits are written
  Hits& hits;
  const rays::BeamSearch& search;  ///< casts uncertain beams
  const Overlaps& overlaps;
};

/// Tight near and far planes around all enabled instances; the resolver has the cast's poses. One
/// box per mesh, relative to its origin.
DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes);

/// Writes the hits of rows [begin, end) of `written` and reports them to the request.
void write_rows(const HitWriter& writer, std::uint32_t begin, std::uint32_t end);

}  // namespace glidar

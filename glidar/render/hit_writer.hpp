// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/progress_counter.hpp>
#include <glidar/render/close_triangles.hpp>
#include <glidar/render/depth_range.hpp>
#include <glidar/render/overlaps.hpp>
#include <glidar/render/plane_points.hpp>
#include <glidar/render/primitive_ref.hpp>
#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <span>

namespace glidar {

/// What a beam meets.
struct CastHit {
  std::size_t beam;
  PrimitiveRef primitive;
};

/// What turns a picture of triangle numbers, or a part of one, into hits.
struct HitWriter {
  const CastRequest& request;
  const Resolver& resolver;
  const TriangleIds& triangles;
  const PlanePoints& points;
  PixelRect drawn;                              ///< the pixels whose numbers are known
  std::span<const std::uint32_t> triangle_ids;  ///< of these, row by row
  PixelRect written;                            ///< those of them whose hits are written
  Hits& hits;
  const rays::BeamSearch& search;  ///< for beams in doubt
  const Overlaps& overlaps;
  /// Beams that hit its triangles are cast, because the picture may show either sheet; nullptr:
  /// none.
  const CloseTriangles* close_triangles = nullptr;
  /// Beams whose hits are known already, whatever was drawn, in rising order.
  std::span<const CastHit> cast_hits = {};
};

/// The planes that hug all instances that are there for a cast; the resolver has its poses. One
/// box per mesh, relative to its origin.
DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes);

/// Writes the hits of rows [begin, end) of the part and tells the request of them.
void write_rows(const HitWriter& writer, std::uint32_t begin, std::uint32_t end);

/// Writes the hits of the whole part, sharing rows out among threads.
void write_image(const HitWriter& writer, ThreadPool& thread_pool, ProgressCounter& count);

}  // namespace glidar

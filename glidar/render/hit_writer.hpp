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
struct KnownHit {
  std::size_t beam;
  Found found;
};

/// What turns a picture of triangle numbers, or a part of one, into hits.
struct PictureWriting {
  const CastRequest& request;
  const Resolver& resolver;
  const TriangleNumbers& triangles;
  const PlanePoints& points;
  PixelRect drawn;                         ///< the pixels whose numbers are known
  std::span<const std::uint32_t> numbers;  ///< of these, row by row
  PixelRect part;                          ///< those of them whose hits are written
  Hits& hits;
  const rays::BeamSearch& search;  ///< for beams in doubt
  const Overlaps& overlaps;
  /// Beams that hit its triangles are cast, because the picture may show either sheet; nullptr:
  /// none.
  const CloseSheets* sheets = nullptr;
  /// Beams whose hits are known already, whatever was drawn, in rising order.
  std::span<const KnownHit> known = {};
};

/// The planes that hug all instances that are there for a cast; the resolver has its poses. One
/// box per mesh, relative to its origin.
DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes);

/// Writes the hits of rows [begin, end) of the part and tells the request of them.
void write_rows(const PictureWriting& writing, std::uint32_t begin, std::uint32_t end);

/// Writes the hits of the whole part, sharing rows out among threads.
void write_picture(const PictureWriting& writing, ThreadPool& thread_pool, ProgressCounter& count);

}  // namespace glidar

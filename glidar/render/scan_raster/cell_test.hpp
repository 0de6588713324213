// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/block_rows.hpp>
#include <glidar/render/scan_raster/cell_rect.hpp>

// Tests one triangle with the beams of eight adjacent cells.
namespace glidar::rays::GLIDAR_KERNEL {

using scan_raster::Placement;
using scan_raster::SectorBuffer;
using scan_raster::SectorView;

/// Inputs for drawing an instance into a sector.
struct DrawContext {
  const GridView& grid;
  const SectorView& sector;
  const Placement& placement;
  const SectorBuffer& buffer;
  FrameTransform rotation;
  FrameTransform slopes;  ///< into the frame of slopes

  GLIDAR_INLINE DrawContext(const GridView& g, const SectorView& s, const Placement& p,
                            const SectorBuffer& c)
      : grid(g),
        sector(s),
        placement(p),
        buffer(c),
        rotation(p.sector_from_object),
        slopes(p.slopes_from_object) {}
};

/// The transform into the frame of these cells' slopes.
template <class Cells>
GLIDAR_INLINE const FrameTransform& slopes_frame(const DrawContext& context) {
  return Cells::kUsesRotation ? context.rotation : context.slopes;
}

/// Bounds of edge functions and of den, for vectors that were transformed into the sector's frame:
/// a product of three terms with a rounded matrix adds 4 u |q|_1 <= 8 u L s to the 20 u L s of
/// rays/triangle_filter.hpp, whose bounds are 24 u L s; and 4 u s1 s2 to 8.2 u s1 s2 (10).
inline constexpr float kTransformMargin = 1.5F;

/// Values of eight triangles. Distances det / den are in metres.
struct TriangleRows : BlockRows<Float8, 19> {
  static constexpr unsigned kQ1 = 0;
  static constexpr unsigned kQ2 = 3;
  static constexpr unsigned kN = 6;
  static constexpr unsigned kDet = 9;
  static constexpr unsigned kEdgeBound = 10;  ///< of ErrorBounds
  static constexpr unsigned kDetBound = 11;
  static constexpr unsigned kDenBound = 12;
  static constexpr unsigned kE1 = 13;  ///< only for beams with origins of their own
  static constexpr unsigned kE2 = 16;

  [[nodiscard]] GLIDAR_INLINE ErrorBounds<Float8> error_bounds(unsigned i) const {
    return bounds(kEdgeBound, i);
  }
};

/// One of eight triangles.
struct RowTriangle {
  const TriangleRows& rows;
  unsigned index;      ///< of the eight
  std::uint32_t slot;  ///< in the tree
  bool faces;          ///< the sign of det is certain, and flipped to positive
};

GLIDAR_INLINE Vector<Float8> load3(const float* const (&of_cell)[3], std::size_t cell) {
  return {Float8::load_unaligned(of_cell[0] + cell), Float8::load_unaligned(of_cell[1] + cell),
          Float8::load_unaligned(of_cell[2] + cell)};
}

/// Reinterprets a number as a float, so that it can be blended.
GLIDAR_INLINE float bits_of_number(std::uint32_t number) {
  float result;
  __builtin_memcpy(&result, &number, sizeof(result));
  return result;
}

/// Keeps the triangle in the cells where it is surely nearer, and re-tests it exactly where that is
/// uncertain.
GLIDAR_INLINE void keep_nearer(const DrawContext& context, const RowTriangle& triangle,
                               std::size_t cell, const EdgeTest<Float8>& edges, Mask8 candidates,
                               Float8 det) {
  const SectorBuffer& buffer = context.buffer;
  const Placement& placement = context.placement;
  const Float8 zero = Float8::all(0.0F);
  const Interval<Float8> best = {Float8::load_unaligned(buffer.low + cell),
                                 Float8::load_unaligned(buffer.high + cell), zero, zero};
  const FilterResult<Float8> result =
      classify(edges, candidates, det, triangle.rows.error_bounds(triangle.index), best);
  std::uint32_t uncertain = bits(result.uncertain);
  const std::uint32_t accepted = bits(result.accepted);
  if (placement.always_retests) {
    uncertain |= accepted;
  } else if (accepted != 0) {
    const Float8 number = Float8::all(bits_of_number(placement.first_number + triangle.slot));
    store_unaligned(buffer.low + cell, select(result.accepted, result.low, best.low));
    store_unaligned(buffer.high + cell, select(result.accepted, result.high, best.high));
    const Float8 before = Float8::load_unaligned(buffer.number + cell);
    store_unaligned(buffer.number + cell, select(result.accepted, number, before));
  }
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(uncertain));
    placement.retest_exactly(placement.context, static_cast<std::uint32_t>(cell) + lane,
                             triangle.slot);
  }
}

/// det of the cells' beams: that of the sector's origin, minus the effect of their offsets.
template <bool kOwnOrigins>
GLIDAR_INLINE Float8 det_at(const DrawContext& context, const RowTriangle& t, std::size_t cell) {
  const Float8 det = t.rows.all(TriangleRows::kDet, t.index);
  if constexpr (kOwnOrigins) {
    return det - dot(load3(context.sector.offset, cell), t.rows.all3(TriangleRows::kN, t.index));
  }
  return det;
}

/// Cells [cell, cell + 8). Cells beyond the last column are tested without effect.
template <bool kOwnOrigins>
GLIDAR_INLINE void test_cells(const DrawContext& context, const RowTriangle& t, std::size_t cell) {
  const Vector<Float8> d = load3(context.sector.direction, cell);
  const Float8 den = dot(d, t.rows.all3(TriangleRows::kN, t.index));
  Float8 v = dot(d, t.rows.all3(TriangleRows::kQ1, t.index));
  Float8 u = dot(d, t.rows.all3(TriangleRows::kQ2, t.index));
  if constexpr (kOwnOrigins) {  // d.((A - o) x e1) = d.q1 - (d x o).e1
    const Vector<Float8> m = load3(context.sector.moment, cell);
    v = v - dot(m, t.rows.all3(TriangleRows::kE1, t.index));
    u = u + dot(m, t.rows.all3(TriangleRows::kE2, t.index));
  }
  const EdgeTest<Float8> edges(u, v, den);
  const Float8 bound = t.rows.all(TriangleRows::kEdgeBound, t.index);
  Mask8 outside = edges.lowest < -bound;
  if (!t.faces) outside = outside & (edges.highest > bound);
  const Mask8 candidates = ~outside;
  if (bits(candidates) == 0) return;
  keep_nearer(context, t, cell, edges, candidates, det_at<kOwnOrigins>(context, t, cell));
}

/// The same where all beams certainly pass inside of the edges.
template <bool kOwnOrigins>
GLIDAR_INLINE void test_inside(const DrawContext& context, const RowTriangle& t, std::size_t cell) {
  const Vector<Float8> d = load3(context.sector.direction, cell);
  const EdgeTest<Float8> edges =
      EdgeTest<Float8>::inside(dot(d, t.rows.all3(TriangleRows::kN, t.index)));
  keep_nearer(context, t, cell, edges, Float8::mask(0xFF), det_at<kOwnOrigins>(context, t, cell));
}

}  // namespace glidar::rays::GLIDAR_KERNEL

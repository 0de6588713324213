// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/tree_traversal.hpp>
#include <glidar/render/scan_raster/leaf_draw.hpp>

// Traverses an instance's tree for a sector, near children first.
namespace glidar::rays::GLIDAR_KERNEL {

/// A node or leaf to visit.
struct NodeVisit {
  float near;  ///< no beam meets it before, metres
  std::int32_t child;
  TileRect tiles;
};

/// Eight boxes in the frame of slopes, grown by the foot of the beams.
struct ProjectedBoxes {
  Vector<Float8> middle;
  Vector<Float8> half;
  Float8 squared_distance;  ///< from the origin, object units

  GLIDAR_INLINE ProjectedBoxes(const DrawContext& context, const FrameTransform& transform,
                               const TreeNode& node) {
    const Placement& p = context.placement;
    Float8 centre[3];
    Float8 size[3];
    squared_distance = Float8::all(0.0F);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const Float8 o = Float8::all(static_cast<float>(p.origin[axis]));
      const Float8 low = Float8::load(node.low[axis]) - o;
      const Float8 high = Float8::load(node.high[axis]) - o;
      const Float8 beside = max(max(low, -high), Float8::all(0.0F));
      squared_distance = multiply_add(beside, beside, squared_distance);
      centre[axis] = (low + high) * Float8::all(0.5F);
      size[axis] = (high - low) * Float8::all(0.5F);
    }
    middle = transform({centre[0], centre[1], centre[2]});
    const Vector<Float8> sizes = {size[0], size[1], size[2]};
    half = {dot(magnitude(transform.forward), sizes) + Float8::all(p.margin + p.foot[0]),
            dot(magnitude(transform.side), sizes) + Float8::all(p.margin + p.foot[1]),
            dot(magnitude(transform.up), sizes) + Float8::all(p.margin + p.foot[2])};
  }

  /// Bits of the boxes that are behind the sector, beside, above or below it.
  [[nodiscard]] GLIDAR_INLINE std::uint32_t find_outside(const DrawContext& context) const {
    const GridView& grid = context.grid;
    const float behind = context.placement.behind;
    const auto slope_of = [](float slope) { return slope < 0.0F ? -slope : slope; };
    const auto above = [&](Float8 value, Float8 size, float slope) {
      const Float8 steep = Float8::all(slope_of(slope));
      return value >
             multiply_add(steep, half.x, size) + Float8::all((1.0F + slope_of(slope)) * behind);
    };
    const Float8 side = Float8::all(grid.max_slope) * middle.x;
    return bits(
        (middle.x + half.x < Float8::all(-behind)) |
        above(middle.y - side, half.y, grid.max_slope) |
        above(-middle.y - side, half.y, grid.max_slope) |
        above(middle.z - Float8::all(grid.highest_slope) * middle.x, half.z, grid.highest_slope) |
        above(Float8::all(grid.lowest_slope) * middle.x - middle.z, half.z, grid.lowest_slope));
  }

  /// The slopes of the boxes in front, whose lowest forward coordinate is `nearest`.
  [[nodiscard]] GLIDAR_INLINE Slopes slopes(Float8 nearest) const {
    const Float8 one = Float8::all(1.0F);
    const Float8 near = one / nearest;
    const Float8 far = one / (middle.x + half.x);
    const auto low = [&](Float8 value) { return min(value * near, value * far); };
    const auto high = [&](Float8 value) { return max(value * near, value * far); };
    return {low(middle.y - half.y), high(middle.y + half.y), low(middle.z - half.z),
            high(middle.z + half.z)};
  }
};

/// The nodes to visit, nearest on top.
class VisitStack {
 public:
  GLIDAR_INLINE explicit VisitStack(const TileRect& all) { put(size_++, {0.0F, 0, all}); }

  [[nodiscard]] GLIDAR_INLINE bool is_empty() const { return size_ == 0; }
  GLIDAR_INLINE NodeVisit pop() { return visits_[--size_]; }
  [[nodiscard]] GLIDAR_INLINE unsigned size() const { return size_; }

  /// Inserts a visit among those from `bottom` on.
  GLIDAR_INLINE void push(unsigned bottom, const NodeVisit& visit) {
    unsigned slot = size_++;
    for (; slot > bottom && visits_[slot - 1].near < visit.near; --slot) {
      visits_[slot] = visits_[slot - 1];
    }
    visits_[slot] = visit;
  }

 private:
  GLIDAR_INLINE void put(unsigned slot, const NodeVisit& visit) { visits_[slot] = visit; }

  unsigned size_ = 0;
  NodeVisit visits_[kStackSize];
};

/// Adds the children of a node that the sector may see.
template <class Cells>
void push_children(const DrawContext& context, const TreeNode& node, VisitStack& stack) {
  const Placement& p = context.placement;
  const ProjectedBoxes boxes(context, slopes_frame<Cells>(context), node);
  const Float8 nearest = boxes.middle.x - boxes.half.x;
  const std::uint32_t around = bits(nearest <= Float8::all(p.margin));
  CellRects rects;
  const std::uint32_t seen = Cells::find(context.grid, boxes.slopes(nearest), rects);
  alignas(32) float squared_distance[8];
  store(squared_distance, boxes.squared_distance);
  const unsigned bottom = stack.size();
  for_bits((seen | around) & ~boxes.find_outside(context), [&](unsigned i) {
    const std::int32_t child = node.child[i];
    if (child == kNoChild) return;
    const bool is_around = (around >> i & 1U) != 0;
    const CellRect rect = is_around ? whole_sector(context.grid) : rects.at<Cells>(context.grid, i);
    if (rect.is_empty()) return;
    Stack::prefetch(p.tree, child);
    const float distance =
        __builtin_sqrtf(squared_distance[i]) * kEntryMargin - p.margin - p.distance;
    stack.push(bottom,
               {distance * static_cast<float>(p.metres) * kEntryMargin, child, tiles_of(rect)});
  });
}

template <class Cells, bool kOwnOrigins>
void draw_tree(const DrawContext& context) {
  VisitStack stack(tiles_of(whole_sector(context.grid)));
  while (!stack.is_empty()) {
    const NodeVisit visit = stack.pop();
    if (!is_visible(context, visit.tiles, visit.near)) continue;
    if (visit.child < 0) {
      draw_leaf<Cells, kOwnOrigins>(context, static_cast<std::uint32_t>(~visit.child));
    } else {
      push_children<Cells>(context, context.placement.tree.nodes[visit.child], stack);
    }
  }
}

inline void draw_instance(const GridView& grid, const SectorView& sector,
                          const Placement& placement, const SectorBuffer& buffer) {
  const DrawContext context(grid, sector, placement, buffer);
  if (grid.has_slopes) {
    draw_tree<SlopeCells, false>(context);
  } else if (sector.moment[0] == nullptr) {
    draw_tree<AngleCells, false>(context);
  } else {
    draw_tree<AngleCells, true>(context);
  }
}

}  // namespace glidar::rays::GLIDAR_KERNEL

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/kernel.hpp>
#include <glidar/render/rays/leaf_packet.hpp>

// Traversal of a tree of eight children per node. It is conservative: unnecessary visits cost time,
// but do not change results.
namespace glidar::rays::GLIDAR_KERNEL {

/// Slabs are computed with three roundings: a box is entered where near <= far * kSlabMargin.
inline constexpr float kSlabMargin = 1.0F + 6.0F * 0x1p-23F;
/// Entry distances may be smaller than computed by this factor.
inline constexpr float kEntryMargin = 1.0F - 0x1p-20F;
/// Components below it are replaced: this changes a ray by less than its padding.
inline constexpr float kMinComponent = 1e-18F;
inline constexpr unsigned kStackSize = 7 * kMaxTreeDepth + 8;

/// A child to visit: its index, and its box as 8 * index of its parent + its place there. One
/// integer, so that it is loaded and stored at once.
using Visit = std::uint64_t;
inline constexpr std::uint32_t kNoBox = 0xFFFFFFFFU;

GLIDAR_INLINE Visit visit_of(std::int32_t child, std::uint32_t box) {
  return static_cast<Visit>(static_cast<std::uint32_t>(child)) << 32U | box;
}
GLIDAR_INLINE std::int32_t child_of(Visit visit) {
  return static_cast<std::int32_t>(visit >> 32U);
}
GLIDAR_INLINE std::uint32_t box_of(Visit visit) {
  return static_cast<std::uint32_t>(visit);
}

struct Stack {
  unsigned size = 0;
  float near[kStackSize];  ///< no ray enters it before
  Visit visit[kStackSize];

  explicit Stack(std::int32_t root) { put(size++, 0.0F, visit_of(root, kNoBox)); }

  GLIDAR_INLINE void put(unsigned slot, float entry, Visit what) {
    near[slot] = entry;
    visit[slot] = what;
  }

  /// Adds the children of a node whose bits are set, the nearest on top.
  GLIDAR_INLINE void push(const TreeView& tree, std::uint32_t node, std::uint32_t children,
                          const float (&entries)[8]) {
    const unsigned bottom = size;
    for_bits(children, [&](unsigned i) {
      const std::int32_t child = tree.nodes[node].child[i];
      if (child == kNoChild) return;
      prefetch(tree, child);
      const float entry = entries[i] * kEntryMargin;
      unsigned slot = size++;
      for (; slot > bottom && near[slot - 1] < entry; --slot) {
        put(slot, near[slot - 1], visit[slot - 1]);
      }
      put(slot, entry, visit_of(child, 8 * node + i));
    });
  }

  GLIDAR_INLINE static void prefetch(const TreeView& tree, std::int32_t child) {
    const bool is_node = child >= 0;
    if (!is_node && tree.blocks == nullptr) return;
    const char* what =
        is_node ? reinterpret_cast<const char*>(&tree.nodes[child])
                : reinterpret_cast<const char*>(&tree.blocks[tree.clusters[~child].first_block]);
    __builtin_prefetch(what);
    __builtin_prefetch(what + 64);
    __builtin_prefetch(what + 128);
    __builtin_prefetch(what + 192);
    if (!is_node) __builtin_prefetch(what + 256);
  }
};

GLIDAR_INLINE float reciprocal(float component) {
  const float size = component < 0.0F ? -component : component;
  return 1.0F / (size < kMinComponent ? kMinComponent : component);
}

/// Single rays need no wider boxes.
struct NoWidth {
  struct None {};
  template <class F>
  [[nodiscard]] GLIDAR_INLINE None of(const F (&)[3], const F (&)[3]) const {
    return {};
  }
};
template <class F>
GLIDAR_INLINE F operator+(F a, NoWidth::None) {
  return a;
}
template <class F>
GLIDAR_INLINE F operator-(F a, NoWidth::None) {
  return a;
}

/// One ray and the boxes of eight children.
struct RaySlabs {
  Float8 near_origin[3];
  Float8 far_origin[3];
  Float8 inverse[3];
  bool is_negative[3];

  RaySlabs(const RayPacket& p, unsigned lane) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const float r = reciprocal(p.direction[axis][lane]);
      const Float8 low = Float8::all(p.origin_low[axis][lane]);
      const Float8 high = Float8::all(p.origin_high[axis][lane]);
      is_negative[axis] = r < 0.0F;
      inverse[axis] = Float8::all(r);
      near_origin[axis] = is_negative[axis] ? low : high;
      far_origin[axis] = is_negative[axis] ? high : low;
    }
  }

  /// Bits of the children whose boxes, wider by `width`, the ray enters before `end`, and where.
  template <class Width>
  GLIDAR_INLINE std::uint32_t entered(const TreeNode& node, const Width& width, float end,
                                      float (&near)[8]) const {
    const Float8 low[3] = {Float8::load(node.low[0]), Float8::load(node.low[1]),
                           Float8::load(node.low[2])};
    const Float8 high[3] = {Float8::load(node.high[0]), Float8::load(node.high[1]),
                            Float8::load(node.high[2])};
    const auto wider = width.of(low, high);
    Float8 first = Float8::all(0.0F);
    Float8 last = Float8::all(end);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const Float8 near_bound = is_negative[axis] ? high[axis] + wider : low[axis] - wider;
      const Float8 far_bound = is_negative[axis] ? low[axis] - wider : high[axis] + wider;
      first = max((near_bound - near_origin[axis]) * inverse[axis], first);
      last = min((far_bound - far_origin[axis]) * inverse[axis], last);
    }
    store(near, first);
    return bits(first <= last * Float8::all(kSlabMargin));
  }
};

/// Tests leaves of triangles.
struct TriangleLeaves {
  const TreeView& tree;
  NoWidth width = {};

  GLIDAR_INLINE void operator()(std::uint32_t leaf, RayPacket& p, std::uint32_t lanes) const {
    test_leaf(tree, leaf, p, lanes);
  }
};

/// Calls a function for leaves.
struct VisitedLeaves {
  VisitLeaf visit;
  void* context;
  NoWidth width = {};

  GLIDAR_INLINE void operator()(std::uint32_t leaf, RayPacket& p, std::uint32_t lanes) const {
    visit(context, leaf, p, lanes);
  }
};

/// Traces one ray below a node or leaf.
template <class Leaves>
void trace_below(const TreeView& tree, RayPacket& p, const Leaves& leaves, unsigned lane,
                 std::int32_t root) {
  const RaySlabs slabs(p, lane);
  Stack stack(root);
  alignas(32) float near[8];
  while (stack.size > 0) {
    --stack.size;
    if (stack.near[stack.size] > p.high[lane]) continue;
    const std::int32_t child = child_of(stack.visit[stack.size]);
    if (child < 0) {
      leaves(static_cast<std::uint32_t>(~child), p, 1U << lane);
      continue;
    }
    const auto index = static_cast<std::uint32_t>(child);
    const std::uint32_t entered =
        slabs.entered(tree.nodes[index], leaves.width, p.high[lane], near);
    if (entered != 0) stack.push(tree, index, entered, near);
  }
}

/// All rays of a packet as one interval ray: intervals of origins and of reciprocal directions. An
/// axis along which directions change sign rejects nothing.
struct RayInterval {
  enum class Sign { mixed, positive, negative };
  Sign sign[3];
  Float8 origin_low[3];
  Float8 origin_high[3];
  Float8 inverse_low[3];  ///< of the absolute components
  Float8 inverse_high[3];

  explicit RayInterval(const RayPacket& p) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      origin_low[axis] = Float8::all(min_lane(p.origin_low[axis]));
      origin_high[axis] = Float8::all(max_lane(p.origin_high[axis]));
      set_directions(axis, p.middle[axis] - p.half[axis], p.middle[axis] + p.half[axis]);
    }
  }

  void set_directions(unsigned axis, float low, float high) {
    constexpr float kMargin = 0x1p-21F;
    sign[axis] = low > 0.0F ? Sign::positive : high < 0.0F ? Sign::negative : Sign::mixed;
    if (sign[axis] == Sign::mixed) return;
    const float min_size = low > 0.0F ? low : -high;
    const float max_size = low > 0.0F ? high : -low;
    inverse_low[axis] = Float8::all((1.0F - kMargin) / max_size);
    inverse_high[axis] = Float8::all((1.0F + kMargin) / min_size);
  }

  /// Bits of the children that some ray may enter before `end`, and bounds of where.
  GLIDAR_INLINE std::uint32_t entered(const TreeNode& node, float end, float (&near)[8]) const {
    Float8 first = Float8::all(0.0F);
    Float8 last = Float8::all(end);
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (sign[axis] == Sign::mixed) continue;
      const bool is_positive = sign[axis] == Sign::positive;
      const Float8 low = Float8::load(node.low[axis]);
      const Float8 high = Float8::load(node.high[axis]);
      const Float8 to_near = is_positive ? low - origin_high[axis] : origin_low[axis] - high;
      const Float8 to_far = is_positive ? high - origin_low[axis] : origin_high[axis] - low;
      const Float8 a = inverse_low[axis];
      const Float8 b = inverse_high[axis];
      first = max(min(to_near * a, to_near * b), first);
      last = min(max(to_far * a, to_far * b), last);
    }
    store(near, first);
    return bits(first <= last * Float8::all(kSlabMargin));
  }
};

/// Tests the rays of a packet, one per lane, with a single box.
struct PacketSlabs {
  alignas(64) float inverse[3][kPacketSize];

  explicit PacketSlabs(const RayPacket& p) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned i = 0; i < kPacketSize; i += LaneFloat::kWidth) {
        const LaneFloat d = LaneFloat::load(p.direction[axis] + i);
        const LaneFloat tiny = LaneFloat::all(kMinComponent);
        const LaneFloat replaced = select(magnitude(d) < tiny, tiny, d);
        store(inverse[axis] + i, LaneFloat::all(1.0F) / replaced);
      }
    }
  }

  /// Bits of the rays that enter a child's box, wider by `width`, before their nearest hit.
  template <class Width>
  [[nodiscard]] GLIDAR_INLINE std::uint32_t entering(const TreeNode& node, unsigned child,
                                                     const Width& width, const RayPacket& p) const {
    const LaneFloat low[3] = {LaneFloat::all(node.low[0][child]),
                              LaneFloat::all(node.low[1][child]),
                              LaneFloat::all(node.low[2][child])};
    const LaneFloat high[3] = {LaneFloat::all(node.high[0][child]),
                               LaneFloat::all(node.high[1][child]),
                               LaneFloat::all(node.high[2][child])};
    const auto wider = width.of(low, high);
    std::uint32_t entering = 0;
    for (unsigned i = 0; i < kPacketSize; i += LaneFloat::kWidth) {
      LaneFloat first = LaneFloat::all(0.0F);
      LaneFloat last = LaneFloat::load(p.high + i);
      for (unsigned axis = 0; axis < 3; ++axis) {
        const LaneFloat r = LaneFloat::load(inverse[axis] + i);
        const LaneFloat x = (low[axis] - wider - LaneFloat::load(p.origin_high[axis] + i)) * r;
        const LaneFloat y = (high[axis] + wider - LaneFloat::load(p.origin_low[axis] + i)) * r;
        first = max(min(x, y), first);
        last = min(max(x, y), last);
      }
      entering |= bits(first <= last * LaneFloat::all(kSlabMargin)) << i;
    }
    return entering & p.active;
  }
};

/// The maximum distance at which some ray may still find a nearer hit.
GLIDAR_INLINE float farthest(const RayPacket& p) {
  return max_lane(p.high);
}

/// Finishes a visit if few rays remain or the child is a leaf; false if it is to be continued.
template <class Leaves>
GLIDAR_INLINE bool finish(const TreeView& tree, RayPacket& p, const Leaves& leaves,
                          std::int32_t child, std::uint32_t rays) {
  constexpr int kFewRays = 3;
  if (child < 0) {
    leaves(static_cast<std::uint32_t>(~child), p, rays);
    return true;
  }
  if (__builtin_popcount(rays) > kFewRays) return false;
  for_bits(rays, [&](unsigned lane) { trace_below(tree, p, leaves, lane, child); });
  return true;
}

/// Traverses the tree with all rays of a packet; where few remain, one by one.
template <class Leaves>
void traverse(const TreeView& tree, RayPacket& p, const Leaves& leaves) {
  const RayInterval beam(p);
  const PacketSlabs slabs(p);
  Stack stack(0);
  float end = kFloatInfinity;
  alignas(32) float near[8];
  while (stack.size > 0) {
    --stack.size;
    if (stack.near[stack.size] > end) continue;
    const std::uint32_t box = box_of(stack.visit[stack.size]);
    const std::int32_t child = child_of(stack.visit[stack.size]);
    std::uint32_t rays = p.active;
    if (box != kNoBox) rays = slabs.entering(tree.nodes[box / 8], box % 8, leaves.width, p);
    if (rays == 0) continue;
    if (finish(tree, p, leaves, child, rays)) {
      end = farthest(p);
      continue;
    }
    const auto index = static_cast<std::uint32_t>(child);
    const std::uint32_t entered = beam.entered(tree.nodes[index], end, near);
    if (entered != 0) stack.push(tree, index, entered, near);
  }
}

inline void trace(const TreeView& tree, RayPacket& p) {
  traverse(tree, p, TriangleLeaves{tree});
}

inline void trace_single(const TreeView& tree, RayPacket& p) {
  const TriangleLeaves leaves{tree};
  for_bits(p.active, [&](unsigned lane) { trace_below(tree, p, leaves, lane, 0); });
}

inline void visit_leaves(const TreeView& tree, RayPacket& p, VisitLeaf visit, void* context) {
  traverse(tree, p, VisitedLeaves{visit, context});
}

}  // namespace glidar::rays::GLIDAR_KERNEL

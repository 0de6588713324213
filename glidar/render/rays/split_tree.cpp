// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/split_tree.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/common/triangle_blocks.hpp>
#include <glidar/render/rays/split_boxes.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

namespace glidar::rays {

/// The maximum number of references that sweep_split() divides.
inline constexpr std::uint32_t kMaxSweep = 32;

/// Divides references, at least two, into two sides by the surface area heuristic: sorts them along
/// each axis and tries all positions. The cost of a side is its area times its number of blocks of
/// `block_size`, so that blocks are filled. Reorders the references; returns the size of the first
/// side.
std::uint32_t sweep_split(std::span<BoxReference> references, std::uint32_t block_size,
                          std::array<SplitExtent, 2>& sides);

namespace {

/// Keys of references in the order of their middles along an axis: bits of the middle, then index.
using SweepOrder = std::array<std::uint64_t, kMaxSweep>;

/// Bits that are ordered as the numbers.
std::uint32_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits ^ (bits >> 31U != 0 ? 0xFFFFFFFFU : 0x80000000U);
}

void sort_along(std::span<const BoxReference> references, std::size_t axis, SweepOrder& order) {
  for (std::uint32_t i = 0; i < references.size(); ++i) {
    const float middle = references[i].low[axis] + references[i].high[axis];
    order[i] = std::uint64_t{ordered_bits(middle)} << 32U | i;
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(references.size()));
}

struct SweepCut {
  float cost = kInfinityf;  ///< infinite: none, because areas overflow
  std::size_t axis = 0;
  std::uint32_t first_size = 0;
};

void find_cut_along(std::span<const BoxReference> references, const SweepOrder& order,
                    std::size_t axis, std::uint32_t block_size, SweepCut& best) {
  const auto count = static_cast<std::uint32_t>(references.size());
  const auto at = [&](std::uint32_t i) -> const BoxReference& {
    return references[static_cast<std::uint32_t>(order[i])];
  };
  const auto cost_of = [block_size](const SplitBox& box, std::uint32_t size) {
    const std::uint32_t blocks = (size + block_size - 1) / block_size;
    return box.area() * static_cast<float>(blocks);
  };
  std::array<float, kMaxSweep> second_cost;
  SplitBox box;
  for (std::uint32_t i = count - 1; i > 0; --i) {
    box.extend(low_of(at(i)), high_of(at(i)));
    second_cost[i] = cost_of(box, count - i);
  }
  box = {};
  for (std::uint32_t i = 1; i < count; ++i) {
    box.extend(low_of(at(i - 1)), high_of(at(i - 1)));
    const float cost = cost_of(box, i) + second_cost[i];
    if (cost < best.cost) best = {cost, axis, i};
  }
}

}  // namespace

std::uint32_t sweep_split(std::span<BoxReference> references, std::uint32_t block_size,
                          std::array<SplitExtent, 2>& sides) {
  std::array<SweepOrder, 3> orders;
  SweepCut best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sort_along(references, axis, orders[axis]);
    find_cut_along(references, orders[axis], axis, block_size, best);
  }
  const auto count = static_cast<std::uint32_t>(references.size());
  if (best.first_size == 0) best.first_size = count / 2;
  std::array<BoxReference, kMaxSweep> sorted;
  for (std::uint32_t i = 0; i < count; ++i) {
    sorted[i] = references[static_cast<std::uint32_t>(orders[best.axis][i])];
    sides[i < best.first_size ? 0 : 1].extend(sorted[i]);
  }
  std::copy_n(sorted.begin(), count, references.begin());
  return best.first_size;
}

namespace {

using Indices = std::int32_t __attribute__((vector_size(16)));

constexpr std::uint32_t kMaxBins = 16;
constexpr std::uint32_t kParallelReferences = 4096;    ///< minimum for a task
constexpr std::uint32_t kParallelBinning = 64 * 1024;  ///< minimum for parallel binning of one node
constexpr unsigned kBalancedDepth = 40;                ///< deeper nodes are halved
constexpr float kMinExtent = 0x1p-100F;  ///< of middles that are split: 16 / it is finite

/// Maps doubled middles to bins, along all axes.
struct Binning {
  Quad low;
  Quad scale;

  Binning(const SplitBox& middles, std::uint32_t bins) : low(middles.low) {
    const Quad size = middles.high - middles.low;
    const Quad wide = all(0.9999F * static_cast<float>(bins)) / size;
    scale = size > all(kMinExtent) ? wide : all(0.0F);
  }
  [[nodiscard]] Indices of(const BoxReference& r) const {
    return __builtin_convertvector((low_of(r) + high_of(r) - low) * scale, Indices);
  }
};

struct Bins {
  std::array<std::array<SplitBox, kMaxBins>, 3> box;
  std::array<std::array<std::uint32_t, kMaxBins>, 3> count{};

  void add(const BoxReference& r, const Binning& binning) {
    const Indices at = binning.of(r);
    const Quad low = low_of(r);
    const Quad high = high_of(r);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto bin = static_cast<std::size_t>(at[axis]);
      box[axis][bin].extend(low, high);
      ++count[axis][bin];
    }
  }
  void add(const Bins& other, std::uint32_t bins) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < bins; ++i) {
        box[axis][i].extend(other.box[axis][i]);
        count[axis][i] += other.count[axis][i];
      }
    }
  }
};

struct Split {
  float cost = kInfinityf;  ///< infinite: no split
  std::size_t axis = 0;
  std::int32_t bin = 0;  ///< first of the second side
};

/// Blocks have eight triangles, but half a block also counts as a saving, since it allows merging.
float test_cost(const SplitBox& box, std::uint32_t count) {
  const std::uint32_t half_blocks = (count + 3) / 4;
  return box.area() * static_cast<float>(half_blocks);
}

void find_split_along(const Bins& bins, std::uint32_t bin_count, std::size_t axis, Split& best) {
  std::array<float, kMaxBins> cost_above{};
  std::uint32_t count = 0;
  SplitBox box;
  for (std::size_t i = bin_count - 1; i > 0; --i) {
    box.extend(bins.box[axis][i]);
    count += bins.count[axis][i];
    cost_above[i] = count == 0 ? kInfinityf : test_cost(box, count);
  }
  box = {};
  count = 0;
  for (std::size_t i = 1; i < bin_count; ++i) {
    box.extend(bins.box[axis][i - 1]);
    count += bins.count[axis][i - 1];
    if (count == 0) continue;
    const float cost = test_cost(box, count) + cost_above[i];
    if (cost < best.cost) best = {cost, axis, static_cast<std::int32_t>(i)};
  }
}

/// Builds the nodes of the subtrees. Threads append them in any order, so that only memory for as
/// many as there are is touched.
class Builder {
 public:
  Builder(std::span<BoxReference> references, const SplitOptions& options, SplitNode* nodes)
      : references_(references), options_(options), nodes_(nodes) {}

  /// Returns the number of nodes.
  std::uint32_t build() {
    const SplitExtent extent = extent_of(references_);
    build({0, static_cast<std::uint32_t>(references_.size())}, extent, 0, 0);
    return count_;
  }

 private:
  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
  };

  [[nodiscard]] static SplitExtent extent_of(std::span<const BoxReference> references) {
    SplitExtent extent;
    for (const BoxReference& r : references) extent.extend(r);
    return extent;
  }

  [[nodiscard]] std::span<BoxReference> in(Range range) const {
    return references_.subspan(range.begin, range.size());
  }

  void build(Range range, const SplitExtent& extent, std::uint32_t index, unsigned depth) {
    SplitNode& node = nodes_[index];
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = extent.boxes.low[axis];
      node.high[axis] = extent.boxes.high[axis];
    }
    node.first = range.begin;
    node.count = range.size();
    if (range.size() <= options_.leaf_size) return;
    std::array<SplitExtent, 2> sides;
    const std::uint32_t middle = cut(range, extent, depth, sides);
    const std::uint32_t first = count_.fetch_add(2, std::memory_order_relaxed);
    node.first = first;
    node.count = 0;
    const auto build_first = [&] { build({range.begin, middle}, sides[0], first, depth + 1); };
    const auto build_second = [&] { build({middle, range.end}, sides[1], first + 1, depth + 1); };
    if (range.size() >= kParallelReferences) {
      tbb::parallel_invoke(build_first, build_second);
    } else {
      build_first();
      build_second();
    }
  }

  /// Partitions references into two sides; returns where the second one begins.
  std::uint32_t cut(Range range, const SplitExtent& extent, unsigned depth,
                    std::array<SplitExtent, 2>& sides) const {
    const bool is_free = depth < std::min(kBalancedDepth, options_.max_depth / 2);
    if (is_free && range.size() <= kMaxSweep) {
      const std::uint32_t block_size = options_.leaf_size < kBlockSize ? 1 : kBlockSize;
      return range.begin + sweep_split(in(range), block_size, sides);
    }
    const Binning binning(extent.middles, options_.bins);
    Split best;
    if (is_free) best = find_split(range, binning, options_.bins);
    if (best.cost < kInfinityf) return partition(range, binning, best, sides);
    const std::uint32_t middle = range.begin + range.size() / 2;
    sides[0] = extent_of(in({range.begin, middle}));
    sides[1] = extent_of(in({middle, range.end}));
    return middle;
  }

  [[nodiscard]] Split find_split(Range range, const Binning& binning, std::uint32_t count) const {
    Bins bins;
    if (range.size() < kParallelBinning) {
      for (const BoxReference& r : in(range)) bins.add(r, binning);
    } else {
      bins = tbb::parallel_reduce(
          tbb::blocked_range<std::uint32_t>(range.begin, range.end, kParallelBinning / 4), Bins{},
          [&](const auto& part, Bins some) {
            for (const BoxReference& r : in({part.begin(), part.end()})) some.add(r, binning);
            return some;
          },
          [&](Bins a, const Bins& b) {
            a.add(b, count);
            return a;
          });
    }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (binning.scale[axis] > 0.0F) find_split_along(bins, count, axis, best);
    }
    return best;
  }

  std::uint32_t partition(Range range, const Binning& binning, const Split& split,
                          std::array<SplitExtent, 2>& sides) const {
    const auto is_first = [&](const BoxReference& r) {
      return binning.of(r)[split.axis] < split.bin;
    };
    std::uint32_t low = range.begin;
    std::uint32_t high = range.end;
    while (low < high) {
      if (is_first(references_[low])) {
        sides[0].extend(references_[low++]);
        continue;
      }
      --high;
      sides[1].extend(references_[low]);
      std::swap(references_[low], references_[high]);
    }
    return low;
  }

  std::span<BoxReference> references_;
  const SplitOptions& options_;
  SplitNode* nodes_;
  std::atomic<std::uint32_t> count_ = 1;
};

}  // namespace

SplitTree build_split_tree(std::span<BoxReference> references, const SplitOptions& options,
                           ThreadPool& thread_pool) {
  SplitTree tree;
  if (references.empty()) return tree;
  tree.nodes = std::make_unique_for_overwrite<SplitNode[]>(2 * references.size());
  Builder builder(references, options, tree.nodes.get());
  thread_pool.execute([&] { tree.count = builder.build(); });
  return tree;
}

}  // namespace glidar::rays

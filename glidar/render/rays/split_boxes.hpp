// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>
#include <glidar/render/rays/split_tree.hpp>

// Boxes of the construction of trees, in vectors of four numbers.
namespace glidar::rays {

using Quad = float __attribute__((vector_size(16), may_alias));

inline Quad low_of(const BoxReference& r) {
  return *reinterpret_cast<const Quad*>(r.low);
}
inline Quad high_of(const BoxReference& r) {
  return *reinterpret_cast<const Quad*>(r.high);
}
inline Quad all(float x) {
  return Quad{x, x, x, x};
}
inline Quad min(Quad a, Quad b) {
  return a < b ? a : b;
}
inline Quad max(Quad a, Quad b) {
  return a > b ? a : b;
}

/// x, y, z; the fourth component is unused.
struct SplitBox {
  Quad low = all(kInfinityf);
  Quad high = all(-kInfinityf);

  void extend(Quad other_low, Quad other_high) {
    low = min(low, other_low);
    high = max(high, other_high);
  }
  void extend(const SplitBox& other) { extend(other.low, other.high); }
  /// Half its surface; 0 for an empty box.
  [[nodiscard]] float area() const {
    const Quad size = high - low;
    return size[0] < 0.0F ? 0.0F : size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// The boxes of some references, and of their doubled middles.
struct SplitExtent {
  SplitBox boxes;
  SplitBox middles;

  void extend(const BoxReference& r) {
    boxes.extend(low_of(r), high_of(r));
    const Quad middle = low_of(r) + high_of(r);
    middles.extend(middle, middle);
  }
  void extend(const SplitExtent& other) {
    boxes.extend(other.boxes);
    middles.extend(other.middles);
  }
};

}  // namespace glidar::rays

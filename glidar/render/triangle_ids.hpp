// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/primitive_ref.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace glidar {

/// A rectangle of a picture's pixels.
struct PixelRect {
  std::uint32_t first_row;
  std::uint32_t first_col;
  std::uint32_t rows;
  std::uint32_t cols;
};

/// Set in the number of a triangle that the pixel's beam certainly does not pass by.
inline constexpr std::uint32_t kCertainFlag = std::uint32_t{1} << 31U;

/// Set in the number of a pixel where another triangle is so close that the beam has to be cast.
inline constexpr std::uint32_t kContestedFlag = std::uint32_t{1} << 30U;

/// The bits of a number that are a triangle's.
inline constexpr std::uint32_t kTriangleIdMask = kContestedFlag - 1;

/// "No triangle": nothing was drawn at the pixel. Greater than all triangles' numbers.
inline constexpr std::uint32_t kNoTriangleId = kTriangleIdMask;

/// The triangles of all instances, numbered through, so that 30 bits hold both.
class TriangleIds {
 public:
  /// Throws Error, naming the renderer, when the scene has more triangles than numbers.
  TriangleIds(const Scene& scene, const char* renderer);

  /// The number of an instance's first triangle.
  [[nodiscard]] std::uint32_t first(std::uint32_t instance) const { return first_[instance]; }

  /// For renderers that draw an instance's triangles in an order of their own: which one has the
  /// k-th number. Must stay where it is.
  void set_order(std::uint32_t instance, const std::vector<std::uint32_t>& drawn) {
    drawn_[instance] = drawn.data();
  }

  /// What a number of the picture tells.
  [[nodiscard]] PrimitiveRef decode(std::uint32_t id) const {
    if (id == kNoTriangleId) return {};
    id &= kTriangleIdMask;
    const std::uint32_t instance =
        first_.size() == 1
            ? 0
            : static_cast<std::uint32_t>(std::upper_bound(first_.begin(), first_.end(), id) -
                                         first_.begin() - 1);
    const std::uint32_t index = id - first_[instance];
    return {instance, drawn_[instance] == nullptr ? index : drawn_[instance][index]};
  }

 private:
  std::vector<std::uint32_t> first_;         ///< per instance
  std::vector<const std::uint32_t*> drawn_;  ///< per instance; nullptr: in the mesh's order
};

}  // namespace glidar

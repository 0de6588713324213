// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/primitive_ref.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace glidar {

/// A rectangle of pixels.
struct PixelRect {
  std::uint32_t first_row;
  std::uint32_t first_col;
  std::uint32_t rows;
  std::uint32_t cols;
};

/// Flag: the pixel's beam certainly hits this triangle.
inline constexpr std::uint32_t kCertainFlag = std::uint32_t{1} << 31U;

/// Flag: another triangle is so close that the beam must be cast.
inline constexpr std::uint32_t kContestedFlag = std::uint32_t{1} << 30U;

/// The bits of an id without flags.
inline constexpr std::uint32_t kTriangleIdMask = kContestedFlag - 1;

/// Nothing was drawn at the pixel. Greater than all triangle ids.
inline constexpr std::uint32_t kNoTriangleId = kTriangleIdMask;

/// Consecutive ids for the triangles of all instances, so that 30 bits store both.
class TriangleIds {
 public:
  /// Throws Error when the scene has more triangles than ids.
  explicit TriangleIds(const Scene& scene);

  /// The id of an instance's first triangle.
  [[nodiscard]] std::uint32_t first(std::uint32_t instance) const { return first_[instance]; }

  /// The instance of an id, without flags, of a triangle.
  [[nodiscard]] std::uint32_t instance_of(std::uint32_t id) const {
    if (first_.size() == 1) return 0;
    return static_cast<std::uint32_t>(std::upper_bound(first_.begin(), first_.end(), id) -
                                      first_.begin() - 1);
  }

  /// The first id after those of an instance, as far as another follows.
  [[nodiscard]] std::uint32_t end(std::uint32_t instance) const {
    return instance + 1 < first_.size() ? first_[instance + 1] : kNoTriangleId;
  }

  /// The triangle of an id; kNoTriangleId: none.
  [[nodiscard]] PrimitiveRef decode(std::uint32_t id) const {
    if (id == kNoTriangleId) return {};
    id &= kTriangleIdMask;
    const std::uint32_t instance = instance_of(id);
    return {instance, id - first_[instance]};
  }

 private:
  std::vector<std::uint32_t> first_;  ///< per instance
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/render/lanes.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// The colours of a texture, stored for fast access: four bytes per texel, in tiles of 4x4
/// texels, one per cache line. The four texels around a point, and those of neighbouring hits, are
/// then mostly close together in memory.
class LookupTexture {
 public:
  LookupTexture() = default;
  explicit LookupTexture(const Texture& texture);

  [[nodiscard]] bool is_empty() const { return texels_.empty(); }

  /// The rgb at sixteen texture coordinates, bit-identical to sample().
  void sample(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
              Lanes3<float>& rgb) const;

 private:
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  std::uint32_t tile_columns_ = 0;
  std::vector<std::uint32_t> texels_;  ///< red in the lowest byte, then green and blue
};

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace glidar::opengl {

/// A picture to draw: all of a cast's, or a part of it that fits a target.
struct Picture {
  std::size_t cast;  ///< which of the batch
  PixelRect rect;
  DepthRange depths;
};

/// Pictures of one size that share a target: [first, first + count) of all.
struct PictureGroup {
  std::size_t first;
  std::uint32_t count;
};

/// Adds the parts of a cast's picture, row by row of parts.
void add_parts(const Beams& beams, std::size_t cast, const DepthRange& depths,
               std::vector<Picture>& pictures);

/// Puts pictures that follow each other and have one size together, as many as are worth while.
void group(std::span<const Picture> pictures, std::vector<PictureGroup>& groups);

inline PictureSize size_of(std::span<const Picture> pictures, const PictureGroup& group) {
  const PixelRect& rect = pictures[group.first].rect;
  return {rect.rows, rect.cols, group.count};
}

}  // namespace glidar::opengl

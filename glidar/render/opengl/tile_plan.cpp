// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/tile_plan.hpp>

#include <algorithm>

namespace glidar::opengl {
namespace {

/// More pictures than this in one go save no waiting any more, but leave the processor's cache.
constexpr std::size_t kPixelsTogether = 512UL * 512UL;
constexpr std::uint32_t kPicturesTogether = 64;  // OpenGL 3.3 promises 256 layers

bool goes_with(const Picture& picture, const Picture& first, std::uint32_t count) {
  const std::size_t pixels = std::size_t{first.rect.rows} * first.rect.cols;
  return picture.rect.rows == first.rect.rows && picture.rect.cols == first.rect.cols &&
         count < kPicturesTogether && (count + 1) * pixels <= kPixelsTogether;
}

}  // namespace

void add_parts(const Beams& beams, std::size_t cast, const DepthRange& depths,
               std::vector<Picture>& pictures) {
  constexpr std::uint32_t kSide = 2048;  // drivers of OpenGL 3.3 draw at least half of it
  for (std::uint32_t row = 0; row < beams.rows; row += kSide) {
    for (std::uint32_t col = 0; col < beams.cols; col += kSide) {
      pictures.push_back(
          {cast,
           {row, col, std::min(kSide, beams.rows - row), std::min(kSide, beams.cols - col)},
           depths});
    }
  }
}

void group(std::span<const Picture> pictures, std::vector<PictureGroup>& groups) {
  groups.clear();
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!groups.empty() &&
        goes_with(pictures[i], pictures[groups.back().first], groups.back().count)) {
      ++groups.back().count;
    } else {
      groups.push_back({i, 1});
    }
  }
}

}  // namespace glidar::opengl

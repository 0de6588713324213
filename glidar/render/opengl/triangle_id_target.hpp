// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar::opengl {

/// Number and common size of tiles.
struct TileSize {
  std::uint32_t rows;
  std::uint32_t cols;
  std::uint32_t count;

  [[nodiscard]] std::size_t pixels() const { return std::size_t{rows} * cols; }
};

/// Visibility buffers: tiles of 32-bit triangle ids, one per layer of a texture, with depths, and
/// the memory through which they are read back together. Each tile starts at the corner of its
/// layer; elsewhere a driver would round vertices differently. No multisampling: ids cannot be
/// averaged.
class TriangleIdTarget {
 public:
  /// Allocates memory for these tiles.
  void begin(const TileSize& size);

  /// Draws into this tile from now on, after clearing it to kNoTriangleId.
  void draw_into(std::uint32_t tile);

  /// Starts to copy the tiles to memory of the CPU; drivers of GPUs do not wait.
  void start_reading();

  /// Waits for the copy. The ids, tile by tile and row by row, are readable until end_reading().
  std::span<const std::uint32_t> triangle_ids();
  void end_reading();

 private:
  [[nodiscard]] bool has_room(const TileSize& size) const;
  void make_room(const TileSize& size);

  GlTexture triangle_ids_;
  Renderbuffer depths_;  ///< shared by all tiles
  std::vector<Framebuffer> framebuffers_;
  Buffer read_;
  GLsizeiptr read_bytes_ = 0;
  bool is_mapped_ = false;
  TileSize room_{};
  TileSize size_{};
};

}  // namespace glidar::opengl

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar::opengl {

/// Pictures of one size.
struct TileSize {
  std::uint32_t rows;
  std::uint32_t cols;
  std::uint32_t count;

  [[nodiscard]] std::size_t pixels() const { return std::size_t{rows} * cols; }
};

/// Pictures of 32-bit numbers, one per layer of a texture, with depths, and the memory through
/// which they are read back together. Each lies at the corner of its layer: elsewhere a driver
/// would round its corners otherwise. No multisampling: a number cannot be averaged.
class TriangleIdTarget {
 public:
  /// Makes room for so many pictures.
  void begin(const TileSize& size);

  /// Draws into this picture from now on; all its numbers are kNoTriangleId.
  void draw_into(std::uint32_t tile);

  /// Starts to copy the pictures to where the processor reads them. A GPU's driver does not wait.
  void start_reading();

  /// Waits for the copy. The numbers, picture by picture and row by row, stay readable until
  /// end_reading().
  std::span<const std::uint32_t> triangle_ids();
  void end_reading();

 private:
  [[nodiscard]] bool has_room(const TileSize& size) const;
  void make_room(const TileSize& size);

  GlTexture triangle_ids_;
  Renderbuffer depths_;  ///< of all pictures in turn
  std::vector<Framebuffer> frames_;
  Buffer read_;
  GLsizeiptr read_bytes_ = 0;
  bool is_mapped_ = false;
  TileSize room_{};
  TileSize size_{};
};

}  // namespace glidar::opengl

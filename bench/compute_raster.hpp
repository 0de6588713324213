// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "raw_opengl.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace glidar::bench {

/// A sketch of what a rasteriser of our own would gain on the graphics device, where triangles are
/// smaller than pixels: compute shaders (OpenGL 4.3) place the vertices, keep the least depth of
/// each pixel with atomicMin, then the triangle that has it. Triangles that reach behind the sensor
/// are left out.
class ComputeRaster {
 public:
  /// True when the current context has compute shaders.
  static bool is_possible();

  ComputeRaster(const Model& model, std::uint32_t side);

  void draw_and_read();
  [[nodiscard]] const std::vector<std::uint32_t>& pixels() const { return pixels_; }

 private:
  struct Objects {
    std::array<opengl::Buffer, 5> buffers;  ///< positions, corners, placed, depths, numbers
    std::array<opengl::Program, 3> steps;   ///< place, least depth, whose it is
  };

  void run(std::size_t step, std::size_t count) const;

  opengl::EglContext context_;
  opengl::Use use_;
  std::uint32_t side_;
  std::size_t vertices_;
  std::size_t triangles_;
  std::vector<std::uint32_t> pixels_;
  std::unique_ptr<Objects> objects_;
};

}  // namespace glidar::bench

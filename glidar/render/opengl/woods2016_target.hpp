// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>

#include <cstdint>
#include <vector>

namespace glidar::opengl {

/// An image of four bytes per pixel, with depths. No multisampling: it would mix depths.
class Woods2016Target {
 public:
  /// Resizes and clears the image (all bytes 0), and draws into it from now on.
  void begin(std::uint32_t rows, std::uint32_t cols);

  /// Copies the image to memory, row by row.
  void read(std::vector<std::uint8_t>& rgba);

 private:
  Framebuffer framebuffer_;
  Renderbuffer colours_;
  Renderbuffer depths_;
  GLsizei rows_ = 0;
  GLsizei cols_ = 0;
};

}  // namespace glidar::opengl

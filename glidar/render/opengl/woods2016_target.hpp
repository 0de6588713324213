// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>

#include <cstdint>
#include <vector>

namespace glidar::opengl {

/// A picture of four bytes a pixel, with depths. No multisampling: it would mix depths.
class Woods2016Target {
 public:
  /// Makes room for so many pixels and draws into it from now on; all bytes are 0.
  void begin(std::uint32_t rows, std::uint32_t cols);

  /// Copies the picture out, row by row.
  void read(std::vector<std::uint8_t>& rgba);

 private:
  Framebuffer frame_;
  Renderbuffer colours_;
  Renderbuffer depths_;
  GLsizei rows_ = 0;
  GLsizei cols_ = 0;
};

}  // namespace glidar::opengl

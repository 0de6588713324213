// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/opengl/projection.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace glidar::opengl {

/// "No triangle": nothing was drawn at the pixel.
inline constexpr std::uint32_t kNoNumber = std::numeric_limits<std::uint32_t>::max();

/// A picture of 32-bit numbers, with depths, and the memory through which it is read back. No
/// multisampling: a number cannot be averaged.
class NumberTarget {
 public:
  /// Makes room for so many pixels and draws into it from now on; all numbers are kNoNumber.
  void begin(const PixelRect& rect);

  /// Starts to copy the picture to where the processor reads it, without waiting.
  void start_reading();

  /// Waits for the copy. The numbers, row by row, stay readable until end_reading().
  std::span<const std::uint32_t> numbers();
  void end_reading();

 private:
  void resize(GLsizei width, GLsizei height);

  Framebuffer frame_;
  Renderbuffer numbers_;
  Renderbuffer depths_;
  Buffer read_;
  GLsizei width_ = 0;  ///< of the memory; pictures may be smaller
  GLsizei height_ = 0;
  PixelRect rect_{};
};

}  // namespace glidar::opengl

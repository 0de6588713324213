// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/guide_lines.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <Eigen/Core>
#include <span>

namespace glidar::app {

/// Parameters for drawing points and lines.
struct CloudView {
  int width = 1;  ///< pixels
  int height = 1;
  Eigen::Matrix4f clip_from_anchor = Eigen::Matrix4f::Identity();
  float point_size = 2.0F;  ///< pixels
};

/// Points and lines, drawn into a texture in the current context.
class CloudDrawing {
 public:
  CloudDrawing();

  void set_points(std::span<const ColouredVertex> points);
  void set_lines(std::span<const ColouredVertex> lines);
  /// Draws into the texture, whose first row is the bottom one.
  void draw(const CloudView& style);
  [[nodiscard]] GLuint texture() const { return picture_.name(); }

 private:
  /// Vertices in the device's memory.
  struct Corners {
    opengl::VertexArray arrays;
    opengl::Buffer buffer;
    GLsizei count = 0;
  };
  static void fill(std::span<const ColouredVertex> vertices, Corners& corners);
  void resize(int width, int height);

  opengl::Program program_;
  Corners points_;
  Corners lines_;
  opengl::Framebuffer frame_;
  opengl::GlTexture picture_;
  opengl::Renderbuffer depths_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace glidar::app

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/number_target.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>

namespace glidar::opengl {

void NumberTarget::resize(GLsizei width, GLsizei height) {
  if (width <= width_ && height <= height_) return;
  width_ = std::max(width, width_);
  height_ = std::max(height, height_);
  glBindRenderbuffer(GL_RENDERBUFFER, numbers_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_R32UI, width_, height_);
  glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width_, height_);
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            numbers_.name());
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                            depths_.name());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  glBufferData(GL_PIXEL_PACK_BUFFER,
               GLsizeiptr{width_} * height_ * static_cast<GLsizeiptr>(sizeof(std::uint32_t)),
               nullptr, GL_STREAM_READ);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  check_gl("making room for a picture");
  if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error({.where = "OpenGL",
                 .found = "the driver draws no pictures of 32-bit numbers",
                 .allowed = "",
                 .remedy = "update the driver, or use --renderer embree"});
  }
}

void NumberTarget::begin(const PixelRect& rect) {
  rect_ = rect;
  const auto width = static_cast<GLsizei>(rect.cols);
  const auto height = static_cast<GLsizei>(rect.rows);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_.name());
  resize(width, height);
  glViewport(0, 0, width, height);
  constexpr GLuint kNothing = kNoNumber;
  constexpr GLfloat kFarthest = 0.0F;
  glClearBufferuiv(GL_COLOR, 0, &kNothing);
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

void NumberTarget::start_reading() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.name());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  glReadPixels(0, 0, static_cast<GLsizei>(rect_.cols), static_cast<GLsizei>(rect_.rows),
               GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glFlush();
}

std::span<const std::uint32_t> NumberTarget::numbers() {
  const std::size_t count = std::size_t{rect_.rows} * rect_.cols;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  const void* start =
      glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0,
                       static_cast<GLsizeiptr>(count * sizeof(std::uint32_t)), GL_MAP_READ_BIT);
  check_gl("reading a picture");
  return {static_cast<const std::uint32_t*>(start), count};
}

void NumberTarget::end_reading() {
  glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

}  // namespace glidar::opengl

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/woods2016_target.hpp>

#include <glidar/core/error.hpp>

#include <array>
#include <string>

namespace glidar::opengl {

void Woods2016Target::begin(std::uint32_t rows, std::uint32_t cols) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size);
  if (rows > static_cast<std::uint32_t>(max_size) || cols > static_cast<std::uint32_t>(max_size)) {
    throw Error({.where = "quantized framebuffer",
                 .found = std::to_string(cols) + " x " + std::to_string(rows) + " pixels",
                 .allowed = "up to " + std::to_string(max_size) + " on a side with this driver",
                 .remedy = "leave --quantized-framebuffer out"});
  }
  if (rows_ != static_cast<GLsizei>(rows) || cols_ != static_cast<GLsizei>(cols)) {
    rows_ = static_cast<GLsizei>(rows);
    cols_ = static_cast<GLsizei>(cols);
    glBindRenderbuffer(GL_RENDERBUFFER, colours_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, cols_, rows_);
    glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, cols_, rows_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              colours_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths_.name());
    check_gl("allocating a framebuffer");
  }
  glViewport(0, 0, cols_, rows_);
  constexpr std::array<GLfloat, 4> kNoPaper = {0.0F, 0.0F, 0.0F, 0.0F};
  constexpr GLfloat kFarthest = 0.0F;
  glClearBufferfv(GL_COLOR, 0, kNoPaper.data());
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

void Woods2016Target::read(std::vector<std::uint8_t>& rgba) {
  rgba.resize(std::size_t{4} * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
  glReadPixels(0, 0, cols_, rows_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  check_not_lost();
  check_gl("reading a framebuffer");
}

}  // namespace glidar::opengl

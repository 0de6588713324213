// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/cloud_drawing.hpp>

#include <apps/viewer/shader_text.hpp>
#include <glidar/render/opengl/program.hpp>

#include <array>
#include <cstddef>

namespace glidar::app {

CloudDrawing::CloudDrawing()
    : program_(opengl::make_program({.vertex = {shader_text("coloured.vert.glsl")},
                                     .fragment = {shader_text("coloured.frag.glsl")},
                                     .macros = {}})) {}

void CloudDrawing::fill(std::span<const ColouredVertex> vertices, Corners& corners) {
  corners.count = static_cast<GLsizei>(vertices.size());
  glBindVertexArray(corners.arrays.name());
  glBindBuffer(GL_ARRAY_BUFFER, corners.buffer.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(),
               GL_DYNAMIC_DRAW);
  constexpr GLsizei kStride = sizeof(ColouredVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  glEnableVertexAttribArray(0);
  // OpenGL takes an offset as a pointer
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        static_cast<const char*>(nullptr) + offsetof(ColouredVertex, colour));
  glEnableVertexAttribArray(1);
  glBindVertexArray(0);
}

void CloudDrawing::set_points(std::span<const ColouredVertex> points) {
  fill(points, points_);
}

void CloudDrawing::set_lines(std::span<const ColouredVertex> lines) {
  fill(lines, lines_);
}

void CloudDrawing::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  glBindTexture(GL_TEXTURE_2D, picture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.name(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths_.name());
}

void CloudDrawing::draw(const CloudView& style) {
  constexpr std::array<GLfloat, 4> kBackground = {0.09F, 0.09F, 0.11F, 1.0F};
  constexpr GLfloat kFarthest = 1.0F;
  resize(style.width, style.height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glViewport(0, 0, style.width, style.height);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, kBackground.data());
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glUseProgram(program_.name());
  glUniformMatrix4fv(glGetUniformLocation(program_.name(), "clip_from_anchor"), 1, GL_FALSE,
                     style.clip_from_anchor.data());
  glUniform1f(glGetUniformLocation(program_.name(), "point_size"), style.point_size);
  glBindVertexArray(points_.arrays.name());
  glDrawArrays(GL_POINTS, 0, points_.count);
  glBindVertexArray(lines_.arrays.name());
  glDrawArrays(GL_LINES, 0, lines_.count);
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  opengl::check_gl("drawing the cloud");
}

}  // namespace glidar::app

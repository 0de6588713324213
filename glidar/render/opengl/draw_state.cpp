// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/draw_state.hpp>

#include <bit>

namespace glidar::opengl {

bool has_clip_control() {
  constexpr int kInCore = 45;
  return epoxy_gl_version() >= kInCore || epoxy_has_gl_extension("GL_ARB_clip_control");
}

void set_draw_state(bool has_clip_control, bool cull_back_faces) {
  if (has_clip_control) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);  // of equal depths the first triangle stays
  glFrontFace(GL_CW);
  glCullFace(GL_BACK);
  if (cull_back_faces) {
    glEnable(GL_CULL_FACE);
  } else {
    glDisable(GL_CULL_FACE);
  }
}

void draw_triangles(const DrawRange& range) {
  const std::size_t first_byte = std::size_t{range.first} * sizeof(Triangle);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.count), GL_UNSIGNED_INT,
                 std::bit_cast<const void*>(first_byte));
}

GLint wrap_number(Wrap wrap) {
  return wrap == Wrap::repeat ? 0 : wrap == Wrap::mirror ? 1 : 2;
}

}  // namespace glidar::opengl

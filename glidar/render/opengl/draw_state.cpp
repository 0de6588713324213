// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/draw_state.hpp>

#include <glidar/core/error.hpp>

#include <bit>
#include <string>

namespace glidar::opengl {
namespace {

constexpr int kMinVersion = 33;
constexpr GLuint kTextureUnits = 5;  // as many as the shaders use

void set_pixel_store() {
  for (const GLenum length : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS,
                              GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS}) {
    glPixelStorei(length, 0);
  }
  constexpr GLint kDefault = 4;
  glPixelStorei(GL_PACK_ALIGNMENT, kDefault);
  glPixelStorei(GL_UNPACK_ALIGNMENT, kDefault);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

/// Resets state that this library never changes, but other users of the context may have changed.
void reset_state() {
  for (const GLenum feature : {GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_BLEND, GL_COLOR_LOGIC_OP,
                               GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL, GL_PRIMITIVE_RESTART,
                               GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB, GL_DITHER}) {
    glDisable(feature);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthRange(0.0, 1.0);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  for (GLuint unit = 0; unit < kTextureUnits; ++unit) glBindSampler(unit, 0);
  set_pixel_store();
}

}  // namespace

ScopedDrawState::ScopedDrawState(Context& context) : use_(context) {
  if (epoxy_gl_version() < kMinVersion) {
    throw Error({.where = "OpenGL",
                 .found = "a context of version " + std::to_string(epoxy_gl_version() / 10) + "." +
                          std::to_string(epoxy_gl_version() % 10),
                 .allowed = "3.3 or later",
                 .remedy = ""});
  }
  reset_state();
}

ScopedDrawState::~ScopedDrawState() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glBindVertexArray(0);
  glUseProgram(0);
  glActiveTexture(GL_TEXTURE0);
  if (has_clip_control()) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
}

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

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/render/draw_order.hpp>
#include <glidar/render/opengl/context.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/renderer.hpp>

namespace glidar::opengl {

/// True if depths can use the precision of floats near 0 (GL_ARB_clip_control). OpenGL 3.3 alone
/// cannot: then the fragment shader writes depths.
bool has_clip_control();

/// Makes a context current in this thread for the lifetime of this object. State that drawing and
/// reading depend on is that of a new context; state that drawing changes is reset afterwards.
class ScopedDrawState {
 public:
  explicit ScopedDrawState(Context& context);
  ~ScopedDrawState();
  ScopedDrawState(const ScopedDrawState&) = delete;
  ScopedDrawState& operator=(const ScopedDrawState&) = delete;

 private:
  ScopedContext use_;
};

/// Depth 1 is near and 0 far; rows run downwards in the image, upwards in the window.
void set_draw_state(bool has_clip_control, bool cull_back_faces);

/// Draws a range of the bound vertex array with the current program.
void draw_triangles(const DrawRange& range);

/// Number of a wrap mode in shaders/texel.glsl.
GLint wrap_number(Wrap wrap);

}  // namespace glidar::opengl

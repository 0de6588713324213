// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/render/opengl/context.hpp>
#include <glidar/render/opengl/scene_buffers.hpp>
#include <glidar/render/renderer.hpp>

#include <cstdint>

namespace glidar::opengl {

/// 3.3 alone cannot put the digits of float depths to use (GL_ARB_clip_control): without it the
/// fragment shader writes them.
bool has_clip_control();

/// A context is current in this thread while this lives, and its state is that of a new one as far
/// as drawing and reading depend on it; so is it afterwards where drawing changes it.
class ScopedDrawState {
 public:
  explicit ScopedDrawState(Context& context);
  ~ScopedDrawState();
  ScopedDrawState(const ScopedDrawState&) = delete;
  ScopedDrawState& operator=(const ScopedDrawState&) = delete;

 private:
  ScopedContext use_;
};

/// Depth 1 is near and 0 far; rows run downwards in the picture, upwards in the window.
void set_draw_state(bool has_clip_control, bool cull_back_faces);

/// Draws a range of the bound vertex array with the current program.
void draw_triangles(const DrawRange& range);

/// As shaders/texel.glsl takes it.
GLint wrap_number(Wrap wrap);

}  // namespace glidar::opengl

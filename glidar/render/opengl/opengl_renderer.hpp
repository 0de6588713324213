// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/context.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Rasterisation by OpenGL 3.3 or later, on a GPU or in software, without a display. The device
/// draws the visible triangle's id per pixel; range, normal and all other columns are computed from
/// that triangle in double, by the code that all renderers share.
///
/// Only pinhole cameras without distortion are supported, with all beams from the sensor's origin.
/// Other beams throw Error, because depth images would not be exact for them. A beam hits the same
/// triangle as a cast ray, except within about 1/64 of a pixel of the border of a hole in an alpha
/// mask, or of a line where surfaces of one mesh intersect.
std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options);

/// The same with the caller's context, such as that of a window; options.graphics_device is
/// ignored. All required state is set. Afterwards framebuffer, program, depth, culling and clip
/// control are as in a new context; viewport and other bindings are not restored.
std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options,
                                               std::unique_ptr<opengl::Context> context);

}  // namespace glidar

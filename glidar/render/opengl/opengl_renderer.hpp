// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/context.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Rasterisation by OpenGL 3.3 or later, on a GPU or in software, without a display. The device
/// draws which triangle each pixel sees; range, normal and all else are worked out from that
/// triangle in double, by the same code as for every renderer.
///
/// It draws pinhole cameras without distortion only, all beams of which start at the sensor's
/// origin, and throws Error for other beams: to read those off depth images would not be exact.
/// A beam meets the same triangle as a cast ray unless it passes within some 1/64 of a pixel of the
/// border of a hole in an alpha mask, or of a line in which surfaces of one mesh cut each other.
std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options);

/// The same over a context of the caller's, say that of a window; options.graphics_device is not
/// looked at. Whatever the context's state, it sets what it needs. Afterwards framebuffer, program,
/// depth, culling and clip control are as in a new context; viewport and other bindings are not
/// given back.
std::unique_ptr<Renderer> make_opengl_renderer(const Scene& scene, const RendererOptions& options,
                                               std::unique_ptr<opengl::Context> context);

}  // namespace glidar

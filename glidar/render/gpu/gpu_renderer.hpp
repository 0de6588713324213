// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/context.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Ray casting in compute shaders of OpenGL 4.3, on a GPU or in software, without a display. Hits
/// have the bits of rays for every request: the device finds the triangle and, if no more is
/// requested, the range of all beams for which it can prove the result; the processor casts the
/// others. See docs/internals/gpu.md. Throws Error where the device cannot do this exactly.
std::unique_ptr<Renderer> make_gpu_renderer(const Scene& scene, const RendererOptions& options);

/// The same with the caller's context, such as that of a window; options.graphics_device is
/// ignored. Afterwards no program is in use; bindings of buffers are not restored.
std::unique_ptr<Renderer> make_gpu_renderer(const Scene& scene, const RendererOptions& options,
                                            std::unique_ptr<opengl::Context> context);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/phong_headlight.hpp>
#include <glidar/render/opengl/context.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>
#include <optional>

namespace glidar {

/// The planes of equation (8).
struct Woods2016DepthPlanes {
  double near_m;
  double far_m;
};

/// Draws quantized framebuffers.
class Woods2016Camera {
 public:
  Woods2016Camera() = default;
  Woods2016Camera(const Woods2016Camera&) = delete;
  Woods2016Camera& operator=(const Woods2016Camera&) = delete;
  virtual ~Woods2016Camera() = default;

  /// Draws a pinhole's image; hit columns, on_tile_done and progress are ignored. The depth
  /// planes enclose the visible surfaces tightly, unless others are given.
  virtual void draw(const CastRequest& request, const PhongHeadlight& light,
                    const std::optional<Woods2016DepthPlanes>& planes,
                    Woods2016Framebuffer& framebuffer) = 0;
};

/// Builds a camera over a valid scene, which must outlive it. Throws Error without OpenGL.
std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options);

/// The same with the caller's context, see make_gpu_renderer().
std::unique_ptr<Woods2016Camera> make_woods2016_camera(const Scene& scene,
                                                       const RendererOptions& options,
                                                       std::unique_ptr<opengl::Context> context);

}  // namespace glidar

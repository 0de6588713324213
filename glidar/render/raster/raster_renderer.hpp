// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Rasterises pinhole cameras on the CPU: clusters of triangles, front to back, vectorised, one
/// tile of the image at a time.
std::unique_ptr<Renderer> make_raster_renderer(const Scene& scene, const RendererOptions& options);
std::unique_ptr<Renderer> make_raster_renderer(std::shared_ptr<CpuBase> base);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Rasterization on the CPU: pinhole cameras by raster/, scanners and cameras with lenses by
/// scan_raster/. Throws Error for other beams. Each is built when it is first needed.
std::unique_ptr<Renderer> make_cpu_raster_renderer(const Scene& scene,
                                                   const RendererOptions& options);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Selects the faster renderer for each cast: a raster for pinhole cameras and scanners that see
/// few triangles per beam, rays for all others. The choice follows from the request alone, and so
/// do the results. Each renderer is built when it is first needed.
std::unique_ptr<Renderer> make_auto_renderer(const Scene& scene, const RendererOptions& options);

}  // namespace glidar

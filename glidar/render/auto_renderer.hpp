// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// The quicker one for each cast: a raster for pinholes and scanners that see few triangles per
/// beam, rays for all others. Which one follows from the request alone, so that results do so too.
/// Each is built when it is first needed.
std::unique_ptr<Renderer> make_auto_renderer(const Scene& scene, const RendererOptions& options);

}  // namespace glidar

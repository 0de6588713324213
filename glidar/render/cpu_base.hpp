// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/rays/scene_search.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>

#include <memory>

namespace glidar {

/// Thread pool, resolver and search, which CPU renderers over the same scene share.
struct CpuBase {
  /// Throws Error unless the scene is valid.
  CpuBase(const Scene& scene, unsigned threads)
      : thread_pool(threads), resolver((validate(scene), scene)), search(resolver, thread_pool) {}

  ThreadPool thread_pool;
  Resolver resolver;
  rays::SceneSearch search;
};

/// Rasterises pinhole cameras on the CPU: clusters of triangles, front to back, vectorised, one
/// tile of the image at a time.
std::unique_ptr<Renderer> make_raster_renderer(const Scene& scene, const RendererOptions& options);
std::unique_ptr<Renderer> make_raster_renderer(std::shared_ptr<CpuBase> base);

}  // namespace glidar

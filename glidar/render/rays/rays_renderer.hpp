// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/renderer.hpp>

#include <memory>

namespace glidar {

/// Ray casting on the CPU by the hit rule, in packets over 4x4 tiles of the beam grid: see
/// docs/internals/ray-casting.md.
std::unique_ptr<Renderer> make_rays_renderer(const Scene& scene, const RendererOptions& options);
std::unique_ptr<Renderer> make_rays_renderer(std::shared_ptr<CpuBase> base);

}  // namespace glidar

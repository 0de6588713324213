// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>
#include <glidar/render/woods2016_camera.hpp>

#include <functional>
#include <memory>

namespace glidar {

/// True when a mesh of the scene has parts with origins of their own (Mesh::origins).
bool has_pieces(const Scene& scene);

using MakeRenderer = std::function<std::unique_ptr<Renderer>(const Scene&)>;
using MakeWoods2016Camera = std::function<std::unique_ptr<Woods2016Camera>(const Scene&)>;

/// Renderers support meshes with one origin only. This one calls `make` with a copy of the scene in
/// which every piece of a mesh is an instance, and converts hits back to the instances and
/// triangles of the scene. Throws Error unless the scene is valid.
std::unique_ptr<Renderer> make_pieces_renderer(const Scene& scene, const MakeRenderer& make);

/// The same for the camera of the quantized framebuffer, which stores no instances.
std::unique_ptr<Woods2016Camera> make_pieces_camera(const Scene& scene,
                                                    const MakeWoods2016Camera& make);

}  // namespace glidar

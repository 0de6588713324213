// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/scene_buffers.hpp>

#include <vector>

namespace glidar::opengl {

/// A mesh with all that its shading needs, in the memory of the graphics device. Attributes: 0
/// position, 1 and 2 texture coordinates, 3 normal, 4 tangent, 5 colour; those that the mesh lacks
/// are the context's constants.
struct ShadedMesh {
  VertexArray arrays;
  Buffer triangles;
  std::vector<Buffer> attributes;
  std::vector<DrawRange> ranges;
  bool is_smooth = false;  ///< it has normals, and no triangle's cancel out
  Buffer flat_normals;     ///< of the triangles in the order of the draw, 4 floats each
  GlTexture flat_normals_view;
};

/// A scene with its textures (RGBA, as core/material.cpp spreads them).
struct ShadedScene {
  std::vector<ShadedMesh> meshes;
  std::vector<GlTexture> textures;
};

ShadedScene upload_shaded(const Scene& scene);

}  // namespace glidar::opengl

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>
#include <glidar/render/draw_order.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <vector>

namespace glidar::opengl {

/// A mesh with all attributes for shading, in the memory of the graphics device. Attributes: 0
/// position, 1 and 2 texture coordinates, 3 normal, 4 tangent, 5 colour; missing ones are constants
/// of the context.
struct ShadedMesh {
  VertexArray arrays;
  Buffer triangles;
  std::vector<Buffer> attributes;
  std::vector<DrawRange> ranges;  ///< their kinds are kind_of()
  Buffer flat_normals;            ///< of the triangles in drawing order, 4 floats each
  GlTexture flat_normals_view;
};

/// Triangles whose interpolated normal may vanish also need their flat normal.
inline std::uint32_t kind_of(std::uint16_t slot, bool is_smooth) {
  return 2U * slot + (is_smooth ? 0 : 1);
}
inline std::uint32_t slot_of(const DrawRange& range) {
  return range.kind / 2;
}
inline bool is_smooth(const DrawRange& range) {
  return range.kind % 2 == 0;
}

/// A scene with its textures (RGBA, as in core/material.cpp).
struct ShadedScene {
  std::vector<ShadedMesh> meshes;
  std::vector<GlTexture> textures;
};

ShadedScene upload_shaded(const Scene& scene);

}  // namespace glidar::opengl

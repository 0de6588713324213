// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>
#include <glidar/render/draw_order.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace glidar::opengl {

/// A mesh in the memory of the graphics device.
struct MeshBuffers {
  VertexArray arrays;  ///< attribute 0: positions relative to the mesh's origin
  Buffer positions;
  Buffer triangles;
  std::array<Buffer, 2> uvs;
  std::array<bool, 2> has_uvs{};
  std::vector<DrawRange> ranges;  ///< by material slot
  /// Triangle of the mesh at each position of the drawing order.
  std::vector<std::uint32_t> drawn;
};

/// The alpha mask of a material: opacity = Material::opacity * the texture's last channel.
struct MaskTexture {
  std::uint32_t material;
  GlTexture texels;  ///< one channel
};

/// A scene in the memory of the graphics device.
struct SceneBuffers {
  std::vector<MeshBuffers> meshes;
  std::vector<MaskTexture> masks;
};

/// True when the material has an alpha mask.
bool has_mask(const Material& material);

template <class Value>
void fill(const Buffer& buffer, GLenum target, const std::vector<Value>& values) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data(),
               GL_STATIC_DRAW);
}

/// Copies a valid scene over. Triangles are ordered by slot where an instance of their mesh has a
/// material with a mask.
SceneBuffers upload(const Scene& scene);

}  // namespace glidar::opengl

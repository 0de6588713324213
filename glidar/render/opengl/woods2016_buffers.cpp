// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/woods2016_buffers.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/planes.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar::opengl {
namespace {

template <class Value>
void fill(const Buffer& buffer, GLenum target, const std::vector<Value>& values) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data(),
               GL_STATIC_DRAW);
}

/// Uploads an attribute of the bound vertex array, if the mesh has it.
template <class Vector>
void give(GLuint attribute, const DrawOrder& order, const std::vector<Vector>& values,
          ShadedMesh& mesh) {
  if (values.empty()) return;
  fill(mesh.attributes.emplace_back(), GL_ARRAY_BUFFER, in_order(order, values));
  glVertexAttribPointer(attribute, Vector::RowsAtCompileTime, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(attribute);
}

void upload_flat_normals(const Mesh& mesh, const std::vector<std::uint32_t>& drawn,
                         const ShadedMesh& shaded) {
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_size);
  if (drawn.size() > static_cast<std::size_t>(max_size)) {
    throw Error({.where = "opengl renderer",
                 .found = "a mesh of " + std::to_string(drawn.size()) + " triangles",
                 .allowed = "up to " + std::to_string(max_size) +
                            " with this driver's quantized framebuffer",
                 .remedy = "leave --quantized-framebuffer out"});
  }
  std::vector<Eigen::Vector4f> normals;
  normals.reserve(drawn.size());
  for (const std::uint32_t t : drawn) {
    normals.push_back(plane_of(mesh, t).normal.cast<float>().homogeneous());
  }
  fill(shaded.flat_normals, GL_TEXTURE_BUFFER, normals);
  glBindTexture(GL_TEXTURE_BUFFER, shaded.flat_normals_view.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, shaded.flat_normals.name());
}

/// Interpolated unit vectors less than 120 degrees apart do not vanish.
bool has_smooth_normals(const Mesh& mesh, const Triangle& t) {
  constexpr float kCosineOf120 = -0.5F;
  if (mesh.normals.empty()) return false;
  const Eigen::Vector3f& a = mesh.normals[t[0]];
  const Eigen::Vector3f& b = mesh.normals[t[1]];
  const Eigen::Vector3f& c = mesh.normals[t[2]];
  return std::min({a.dot(b), b.dot(c), c.dot(a)}) > kCosineOf120;
}

std::vector<std::uint32_t> kinds_of(const Mesh& mesh) {
  std::vector<std::uint32_t> kinds;
  kinds.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    kinds.push_back(kind_of(material_slot(mesh, i), has_smooth_normals(mesh, mesh.triangles[i])));
  }
  return kinds;
}

ShadedMesh upload_mesh(const Mesh& mesh) {
  ShadedMesh shaded;
  DrawOrder order = draw_order(mesh, kinds_of(mesh));
  glBindVertexArray(shaded.arrays.name());
  give(0, order, mesh.positions_m, shaded);
  give(1, order, mesh.uvs[0], shaded);
  give(2, order, mesh.uvs[1], shaded);
  give(3, order, mesh.normals, shaded);
  give(4, order, mesh.tangents, shaded);
  give(5, order, mesh.colours, shaded);
  fill(shaded.triangles, GL_ELEMENT_ARRAY_BUFFER, order.triangles);
  upload_flat_normals(mesh, order.drawn, shaded);
  shaded.ranges = std::move(order.ranges);
  return shaded;
}

/// Converts a texture to RGBA; a missing alpha is opaque.
std::vector<std::uint8_t> to_rgba(const Texture& texture) {
  const std::size_t pixels = std::size_t{texture.width} * texture.height;
  const std::size_t n = texture.channels;
  const bool is_grey = n < 3;
  const bool has_alpha = n == 2 || n == 4;
  std::vector<std::uint8_t> rgba(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* from = &texture.texels[n * i];
    rgba[4 * i] = from[0];
    rgba[4 * i + 1] = from[is_grey ? 0 : 1];
    rgba[4 * i + 2] = from[is_grey ? 0 : 2];
    rgba[4 * i + 3] = has_alpha ? from[n - 1] : std::uint8_t{255};
  }
  return rgba;
}

GlTexture upload_texture(const Texture& texture) {
  GlTexture uploaded;
  const std::vector<std::uint8_t> rgba = to_rgba(texture);
  glBindTexture(GL_TEXTURE_2D, uploaded.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(texture.width),
               static_cast<GLsizei>(texture.height), 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // there are no smaller levels
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return uploaded;
}

}  // namespace

ShadedScene upload_shaded(const Scene& scene) {
  ShadedScene shaded;
  for (const Mesh& mesh : scene.meshes) shaded.meshes.push_back(upload_mesh(mesh));
  for (const Texture& texture : scene.textures) {
    shaded.textures.push_back(upload_texture(texture));
  }
  check_gl("taking the scene into the graphics device's memory");
  return shaded;
}

}  // namespace glidar::opengl

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/scene_buffers.hpp>

#include <algorithm>
#include <numeric>

namespace glidar::opengl {
namespace {

bool needs_slots(const Scene& scene, std::size_t mesh) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh == mesh &&
           std::any_of(instance.materials.begin(), instance.materials.end(),
                       [&](std::uint32_t m) { return has_mask(scene.materials[m]); });
  });
}

MeshBuffers upload_mesh(const Mesh& mesh, bool by_slot) {
  MeshBuffers buffers;
  glBindVertexArray(buffers.arrays.name());
  fill(buffers.positions, GL_ARRAY_BUFFER, mesh.positions_m);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  for (std::size_t set = 0; set < buffers.uvs.size(); ++set) {
    buffers.has_uvs[set] = by_slot && !mesh.uvs[set].empty();
    if (buffers.has_uvs[set]) fill(buffers.uvs[set], GL_ARRAY_BUFFER, mesh.uvs[set]);
  }
  if (!by_slot) {
    fill(buffers.triangles, GL_ELEMENT_ARRAY_BUFFER, mesh.triangles);
    buffers.ranges.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size()), 0});
    return buffers;
  }
  buffers.drawn = ordered_by_slot(mesh, buffers.ranges);
  std::vector<Triangle> triangles;
  triangles.reserve(buffers.drawn.size());
  for (const std::uint32_t t : buffers.drawn) triangles.push_back(mesh.triangles[t]);
  fill(buffers.triangles, GL_ELEMENT_ARRAY_BUFFER, triangles);
  return buffers;
}

/// The last channel of a texture, alpha or grey or red, as core/material.cpp takes it.
std::vector<std::uint8_t> opacities(const Texture& texture) {
  const bool has_alpha = texture.channels == 2 || texture.channels == 4;
  const std::size_t channel = has_alpha ? texture.channels - 1 : 0;
  std::vector<std::uint8_t> values(std::size_t{texture.width} * texture.height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = texture.texels[i * texture.channels + channel];
  }
  return values;
}

MaskTexture upload_mask(const Scene& scene, std::uint32_t index) {
  static const Texture kOpaque{.name = "", .width = 1, .height = 1, .channels = 1, .texels = {255}};
  const TextureUse& use = scene.materials[index].alpha_texture;
  const Texture& texture =
      use.used() ? scene.textures[static_cast<std::size_t>(use.texture)] : kOpaque;
  MaskTexture mask{.material = index, .texels = {}};
  const std::vector<std::uint8_t> values = opacities(texture);
  glBindTexture(GL_TEXTURE_2D, mask.texels.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, static_cast<GLsizei>(texture.width),
               static_cast<GLsizei>(texture.height), 0, GL_RED, GL_UNSIGNED_BYTE, values.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // there are no smaller levels
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return mask;
}

}  // namespace

bool has_mask(const Material& material) {
  return material.alpha_cutoff > 0.0F;
}

std::vector<std::uint32_t> ordered_by_slot(const Mesh& mesh, std::vector<DrawRange>& ranges) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return material_slot(mesh, a) < material_slot(mesh, b);
  });
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint16_t slot = material_slot(mesh, order[i]);
    if (i == 0 || slot != ranges.back().slot) ranges.push_back({i, 0, slot});
    ++ranges.back().count;
  }
  return order;
}

SceneBuffers upload(const Scene& scene) {
  SceneBuffers buffers;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    buffers.meshes.push_back(upload_mesh(scene.meshes[i], needs_slots(scene, i)));
  }
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (has_mask(scene.materials[i])) buffers.masks.push_back(upload_mask(scene, i));
  }
  check_gl("taking the scene into the graphics device's memory");
  return buffers;
}

}  // namespace glidar::opengl

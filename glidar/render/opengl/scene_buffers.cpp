// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/scene_buffers.hpp>

#include <algorithm>
#include <utility>

namespace glidar::opengl {
namespace {

bool needs_slots(const Scene& scene, std::size_t mesh) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh == mesh &&
           std::any_of(instance.materials.begin(), instance.materials.end(),
                       [&](std::uint32_t m) { return has_mask(scene.materials[m]); });
  });
}

std::vector<std::uint32_t> slots_of(const Mesh& mesh) {
  return {mesh.material_slots.begin(), mesh.material_slots.end()};
}

MeshBuffers upload_mesh(const Mesh& mesh, bool by_slot) {
  MeshBuffers buffers;
  DrawOrder order = draw_order(mesh, by_slot ? slots_of(mesh) : std::vector<std::uint32_t>{});
  glBindVertexArray(buffers.arrays.name());
  fill(buffers.positions, GL_ARRAY_BUFFER, in_order(order, mesh.positions_m));
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  for (std::size_t set = 0; set < buffers.uvs.size(); ++set) {
    buffers.has_uvs[set] = by_slot && !mesh.uvs[set].empty();
    if (!buffers.has_uvs[set]) continue;
    fill(buffers.uvs[set], GL_ARRAY_BUFFER, in_order(order, mesh.uvs[set]));
  }
  fill(buffers.triangles, GL_ELEMENT_ARRAY_BUFFER, order.triangles);
  buffers.ranges = std::move(order.ranges);
  buffers.drawn = std::move(order.drawn);
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

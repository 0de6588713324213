// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ray_tree.hpp>
#include <glidar/render/resolver.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::gpu {

/// In the shaders: nothing.
inline constexpr std::uint32_t kNone = 0xffffffffU;

/// A leaf in a child's index: bit 31, then the number of triangles less one in 6 bits, then the
/// first triangle.
inline constexpr std::uint32_t kLeafBit = std::uint32_t{1} << 31U;

/// A mesh in the memory of the graphics device.
struct DeviceMesh {
  std::uint32_t root = kNone;  ///< of its tree; kNone: it has no triangles
  std::uint32_t first_plane = 0;
  rays::MeshSphere sphere;
  float coordinate = 0.0F;  ///< at least the largest of a vertex
  float distance = 0.0F;    ///< at least that of the farthest vertex from the origin
};

/// Throws Error where the device has no buffers of this size.
void check_buffer_size(std::size_t bytes);

/// Fills a buffer of the casting shader; OpenGL has no empty ones.
template <class Value>
void fill(const opengl::Buffer& buffer, std::span<const Value> values, GLenum usage) {
  constexpr std::size_t kLeast = 64;
  const std::size_t bytes = values.size_bytes();
  check_buffer_size(bytes);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(std::max(kLeast, bytes)), nullptr,
               usage);
  if (bytes == 0) return;
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), values.data());
}

/// The meshes of a scene in the memory of the graphics device, as the casting shader reads them:
/// trees, triangles in the order of their leaves, and planes in the order of the mesh.
class DeviceScene {
 public:
  /// Requires a current context. Throws Error for a scene beyond the limits of the device.
  DeviceScene(const Resolver& resolver, ThreadPool& thread_pool);

  void bind() const;
  [[nodiscard]] const DeviceMesh& mesh(std::uint32_t mesh) const { return meshes_[mesh]; }
  /// A bit for each slot of an instance whose material has an alpha mask; 31 is that of the rest.
  [[nodiscard]] std::uint32_t masked_slots(std::uint32_t instance) const {
    return masked_slots_[instance];
  }

 private:
  std::array<opengl::Buffer, 3> buffers_;  ///< nodes, triangles, planes
  std::vector<DeviceMesh> meshes_;
  std::vector<std::uint32_t> masked_slots_;  ///< per instance
};

}  // namespace glidar::gpu

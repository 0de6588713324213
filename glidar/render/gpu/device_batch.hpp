// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/opengl/gl_object.hpp>
#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ray_tree.hpp>
#include <glidar/render/rays/scene_trees.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
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

/// Throws Error unless the device of the current context can cast: it has compute shaders and
/// memory that the processor reads, and its 64-bit arithmetic gives the bits of the processor.
void check_device();

/// The beams of the last casts in the memory of the graphics device. Those of a sensor are mostly
/// the same in every frame, and comparing them is faster than transferring them.
class DeviceBeams {
 public:
  /// The buffer with the directions of these beams and then their origins, if they have any.
  /// Beams that hit nothing, because they have no direction or start beyond all limits, have the
  /// direction zero. Valid until the next call.
  const opengl::Buffer& upload(const Beams& beams);

  /// The size of that buffer.
  static std::size_t bytes(const Beams& beams);

 private:
  struct Entry {
    std::vector<Eigen::Vector3d> directions;
    std::vector<Eigen::Vector3d> origins_m;
    opengl::Buffer buffer;
  };

  static constexpr std::size_t kEntries = 4;
  std::array<Entry, kEntries> entries_;
  std::size_t oldest_ = 0;
  std::vector<Eigen::Vector3d> uploaded_;
};

/// In place of a primitive: the host must cast the beam.
inline constexpr std::uint32_t kUndecided = 0xfffffffeU;

/// What the device found for the beams of a view.
struct FoundHits {
  /// Per beam the primitive, kNone or kUndecided; with has_instances its instance follows.
  std::span<const std::uint32_t> ids;
  std::span<const double> range_m;  ///< of decided hits; empty: not requested
  bool has_instances = false;
  std::uint32_t instance = kNone;  ///< of all hits, without has_instances
};

/// The program that casts beams into a scene.
opengl::Program make_cast_program(const Scene& scene);

/// Views that the device casts together: requests with the same beams, culling and columns.
class DeviceBatch {
 public:
  DeviceBatch() = default;
  ~DeviceBatch();
  DeviceBatch(const DeviceBatch&) = delete;
  DeviceBatch& operator=(const DeviceBatch&) = delete;

  /// True if the device can cast a request for which the trees are prepared.
  static bool can_cast(const CastRequest& request, const rays::SceneTrees& trees);

  /// Forgets all views.
  void clear();

  /// Adds the view of a request for which resolver and trees are prepared.
  void add(const CastRequest& request, const DeviceScene& scene, const Resolver& resolver,
           const rays::SceneTrees& trees);

  /// Starts the cast of all views by the current program, to which the scene is bound.
  void start(const CastRequest& request, bool with_ranges, DeviceBeams& beams);

  /// Waits until the device is done.
  void wait();

  /// Of a view that was added, until the next start().
  [[nodiscard]] FoundHits found(std::size_t view) const;

 private:
  /// Memory of the host that the device writes to.
  struct Mapped {
    opengl::Buffer buffer;
    void* data = nullptr;
    std::size_t bytes = 0;
  };
  /// In the layout of the shader.
  struct Frame {
    std::array<std::array<double, 4>, 3> rows;
    std::array<double, 4> sensor;
    std::array<double, 4> sphere;
    std::array<float, 4> reach;
    std::array<std::uint32_t, 4> mesh;
  };
  struct View {
    std::uint32_t first_frame;
    std::uint32_t end_frame;
    std::uint32_t tree_frame;
    std::uint32_t unused;
  };

  static Frame frame_of(const InstanceView& view, const rays::MeshSphere& sphere);
  void add_frame(std::uint32_t instance, double tie_reach_m, const DeviceScene& scene,
                 const Resolver& resolver);
  [[nodiscard]] std::uint32_t add_tree(const rays::SceneTrees& trees, std::size_t instances);
  static void make_room(std::size_t bytes, Mapped& mapped);
  void upload(const CastRequest& request, DeviceBeams& beams);
  void dispatch(const CastRequest& request) const;

  std::array<opengl::Buffer, 4> inputs_;  ///< frames, views, nodes of trees, targets
  Mapped ids_;
  Mapped ranges_;
  GLsync done_ = nullptr;
  std::size_t beams_ = 0;  ///< of each view
  bool has_ranges_ = false;
  bool has_instances_ = false;
  std::vector<Frame> frames_;
  std::vector<View> views_;
  std::vector<rays::TreeNode> nodes_;
  std::vector<rays::TreeNode> tree_;        ///< that is being added
  std::size_t last_tree_ = 0;               ///< where the nodes of the last one start
  std::vector<std::uint32_t> position_of_;  ///< per instance, among those of a view
};

}  // namespace glidar::gpu

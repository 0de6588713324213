// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/device_scene.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/planes.hpp>
#include <glidar/render/rays/mesh_tree.hpp>

#include <algorithm>
#include <bit>
#include <string>

namespace glidar::gpu {
namespace {

using rays::MeshTree;
using rays::TreeNode;

constexpr std::uint32_t kLeafCountShift = 25;
constexpr std::uint32_t kMaxTriangles = (1U << kLeafCountShift) - 64;
/// Few per leaf: neighbouring threads are mostly at different ones.
constexpr std::uint32_t kTrianglesPerLeaf = 2;
constexpr std::uint32_t kLastSlot = 31;
constexpr std::uint32_t kCopyMark = 256;

/// Three corners; the fourth components are the triangle's index in the mesh, its mark, and unused.
using DeviceTriangle = std::array<std::array<float, 4>, 3>;

/// What is uploaded.
struct Arrays {
  std::vector<TreeNode> nodes;
  std::vector<DeviceTriangle> triangles;
  std::vector<TrianglePlane> planes;
};

[[noreturn]] void fail_too_large(const std::string& found, const std::string& allowed) {
  throw Error({.where = "gpu renderer",
               .found = found,
               .allowed = allowed,
               .remedy = "use --renderer rays"});
}

/// The material's slot, and whether the triangle equals an earlier one, which the hit rule reports.
std::uint32_t mark_of(const Mesh& mesh, const std::uint32_t* first_coincident,
                      std::uint32_t triangle) {
  const std::uint32_t slot = std::min<std::uint32_t>(material_slot(mesh, triangle), kLastSlot);
  const bool is_copy = first_coincident != nullptr && first_coincident[triangle] != triangle;
  return slot + (is_copy ? kCopyMark : 0U);
}

/// Appends the triangles leaf by leaf; returns the first of each leaf.
std::vector<std::uint32_t> append_triangles(const Mesh& mesh, const MeshTree& tree,
                                            const std::uint32_t* first_coincident,
                                            std::vector<DeviceTriangle>& triangles) {
  std::vector<std::uint32_t> first;
  for (const TriangleCluster& cluster : tree.clusters) {
    first.push_back(static_cast<std::uint32_t>(triangles.size()));
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const std::uint32_t slot = cluster.first_block * kBlockSize + i;
      const HitTriangle t = triangle_at(tree.blocks.data(), slot);
      const std::uint32_t index = tree.blocks[slot / kBlockSize].primitive[slot % kBlockSize];
      const std::uint32_t mark = mark_of(mesh, first_coincident, index);
      triangles.push_back({{{t.a[0], t.a[1], t.a[2], std::bit_cast<float>(index)},
                            {t.b[0], t.b[1], t.b[2], std::bit_cast<float>(mark)},
                            {t.c[0], t.c[1], t.c[2], 0.0F}}});
    }
  }
  return first;
}

/// Appends the tree's nodes, with the children's indices in all arrays.
void append_nodes(const MeshTree& tree, const std::vector<std::uint32_t>& first,
                  std::vector<TreeNode>& nodes) {
  const auto root = static_cast<std::uint32_t>(nodes.size());
  const auto convert = [&](std::int32_t child) {
    if (child == rays::kNoChild) return kNone;
    if (child >= 0) return root + static_cast<std::uint32_t>(child);
    const auto leaf = static_cast<std::uint32_t>(~child);
    return kLeafBit | (tree.clusters[leaf].count - 1) << kLeafCountShift | first[leaf];
  };
  for (TreeNode node : tree.nodes) {
    for (std::int32_t& child : node.child) child = std::bit_cast<std::int32_t>(convert(child));
    nodes.push_back(node);
  }
}

void append_planes(const Mesh& mesh, ThreadPool& thread_pool, std::vector<TrianglePlane>& planes) {
  constexpr std::size_t kTrianglesPerTask = 4096;
  const std::size_t first = planes.size();
  planes.resize(first + mesh.triangles.size());
  thread_pool.parallel_for(mesh.triangles.size(), kTrianglesPerTask,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t t = begin; t < end; ++t)
                               planes[first + t] = plane_of(mesh, static_cast<std::uint32_t>(t));
                           });
}

DeviceMesh append(const Mesh& mesh, const MeshTree& tree, const std::uint32_t* first_coincident,
                  Arrays& arrays) {
  DeviceMesh device{.first_plane = static_cast<std::uint32_t>(arrays.planes.size()),
                    .sphere = tree.sphere};
  if (!tree.nodes.empty()) device.root = static_cast<std::uint32_t>(arrays.nodes.size());
  append_nodes(tree, append_triangles(mesh, tree, first_coincident, arrays.triangles),
               arrays.nodes);
  constexpr float kRoundedUp = 1.001F;
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    device.coordinate = std::max(device.coordinate, kRoundedUp * p.cwiseAbs().maxCoeff());
    device.distance = std::max(device.distance, kRoundedUp * p.norm());
  }
  return device;
}

std::uint32_t masked_slots_of(const Scene& scene, const Instance& instance) {
  std::uint32_t slots = 0;
  for (std::uint32_t slot = 0; slot < instance.materials.size(); ++slot) {
    const bool is_masked = scene.materials[instance.materials[slot]].alpha_cutoff > 0.0F;
    slots |= static_cast<std::uint32_t>(is_masked) << std::min(slot, kLastSlot);
  }
  return slots;
}

/// Resolver::first_coincident() of the mesh's first instance that has it.
std::vector<const std::uint32_t*> first_coincident_of(const Resolver& resolver) {
  const Scene& scene = resolver.scene();
  std::vector<const std::uint32_t*> of_mesh(scene.meshes.size(), nullptr);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t*& first = of_mesh[scene.instances[i].mesh];
    if (first == nullptr) first = resolver.first_coincident(i);
  }
  return of_mesh;
}

}  // namespace

void check_buffer_size(std::size_t bytes) {
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  if (bytes <= static_cast<std::size_t>(largest)) return;
  fail_too_large("a buffer of " + std::to_string(bytes) + " bytes",
                 "up to " + std::to_string(largest) + " on this graphics device");
}

DeviceScene::DeviceScene(const Resolver& resolver, ThreadPool& thread_pool) {
  const Scene& scene = resolver.scene();
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  if (triangles > kMaxTriangles) {
    fail_too_large(std::to_string(triangles) + " triangles in all meshes",
                   "up to " + std::to_string(kMaxTriangles));
  }
  Arrays arrays;
  const std::vector<const std::uint32_t*> first_coincident = first_coincident_of(resolver);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const MeshTree tree = rays::build_mesh_tree({.positions = mesh.positions_m,
                                                 .triangles = mesh.triangles,
                                                 .chosen = resolver.distinct(i)},
                                                {.cluster_size = kTrianglesPerLeaf}, thread_pool);
    meshes_.push_back(append(mesh, tree, first_coincident[i], arrays));
    append_planes(mesh, thread_pool, arrays.planes);
  }
  for (const Instance& instance : scene.instances) {
    masked_slots_.push_back(masked_slots_of(scene, instance));
  }
  static_assert(sizeof(TreeNode) == std::size_t{64} * sizeof(float));
  static_assert(sizeof(TrianglePlane) == 4 * sizeof(double));
  fill<TreeNode>(buffers_[0], arrays.nodes, GL_STATIC_DRAW);
  fill<DeviceTriangle>(buffers_[1], arrays.triangles, GL_STATIC_DRAW);
  fill<TrianglePlane>(buffers_[2], arrays.planes, GL_STATIC_DRAW);
  opengl::check_gl("taking the scene into the graphics device's memory");
}

void DeviceScene::bind() const {
  for (GLuint i = 0; i < buffers_.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers_[i].name());
  }
}

}  // namespace glidar::gpu

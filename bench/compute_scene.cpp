// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "compute_scene.hpp"

#include "compute_shaders.hpp"

#include <glidar/core/error.hpp>
#include <glidar/render/pieces_renderer.hpp>
#include <glidar/render/rays/mesh_tree.hpp>

#include <algorithm>
#include <bit>
#include <vector>

namespace glidar::bench {
namespace {

using rays::MeshTree;
using rays::TreeNode;

constexpr std::uint32_t kMaxTriangles = (1U << kLeafCountShift) - 64;

/// Three corners; the first one's fourth component is the triangle's index in the mesh.
using DeviceTriangle = std::array<std::array<float, 4>, 3>;

void check_scene(const Resolver& resolver, const Beams& beams) {
  const Scene& scene = resolver.scene();
  const bool is_simple = scene.instances.size() == 1 && !resolver.is_masked(0) &&
                         !has_pieces(scene) && beams.origins_m.empty() &&
                         scene.meshes[0].triangles.size() <= kMaxTriangles;
  if (is_simple) return;
  throw Error({.where = "casting in compute shaders",
               .found = "a scene or beams of another kind",
               .allowed = "one instance without alpha masks, up to 33554368 triangles, beams "
                          "from the sensor's origin",
               .remedy = "use a renderer"});
}

/// The triangles leaf by leaf; `first` receives the start of each leaf.
std::vector<DeviceTriangle> triangles_of(const MeshTree& tree, std::vector<std::uint32_t>& first) {
  std::vector<DeviceTriangle> triangles;
  for (const TriangleCluster& cluster : tree.clusters) {
    first.push_back(static_cast<std::uint32_t>(triangles.size()));
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const std::uint32_t slot = cluster.first_block * kBlockSize + i;
      const HitTriangle t = triangle_at(tree.blocks.data(), slot);
      const std::uint32_t number = tree.blocks[slot / kBlockSize].primitive[slot % kBlockSize];
      triangles.push_back({{{t.a[0], t.a[1], t.a[2], std::bit_cast<float>(number)},
                            {t.b[0], t.b[1], t.b[2], 0.0F},
                            {t.c[0], t.c[1], t.c[2], 0.0F}}});
    }
  }
  return triangles;
}

/// The tree's nodes in the layout of the shader.
std::vector<TreeNode> nodes_of(const MeshTree& tree, const std::vector<std::uint32_t>& first) {
  std::vector<TreeNode> nodes = tree.nodes;
  for (TreeNode& node : nodes) {
    for (std::int32_t& child : node.child) {
      if (child >= 0) continue;
      const auto leaf = static_cast<std::uint32_t>(~child);
      child = child == rays::kNoChild
                  ? -1
                  : static_cast<std::int32_t>(1U << 31U |
                                              (tree.clusters[leaf].count - 1) << kLeafCountShift |
                                              first[leaf]);
    }
  }
  return nodes;
}

template <class Value>
void fill(const opengl::Buffer& buffer, const std::vector<Value>& values) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(Value)),
               values.data(), GL_STATIC_DRAW);
}

}  // namespace

ComputeScene::ComputeScene(const Resolver& resolver, const Beams& beams, ThreadPool& thread_pool)
    : size_{beams.cols, beams.rows}, sphere_{}, reach_{} {
  check_scene(resolver, beams);
  const Mesh& mesh = resolver.mesh(0);
  const MeshTree tree = rays::build_mesh_tree(
      {.positions = mesh.positions_m, .triangles = mesh.triangles, .chosen = resolver.distinct(0)},
      {.cluster_size = kDeviceLeaf}, thread_pool);
  sphere_ = {tree.sphere.centre[0], tree.sphere.centre[1], tree.sphere.centre[2],
             tree.sphere.radius};
  std::vector<std::uint32_t> first;
  fill(buffers_[1], triangles_of(tree, first));
  fill(buffers_[0], nodes_of(tree, first));
  static_assert(sizeof(TrianglePlane) == 4 * sizeof(double));
  std::vector<TrianglePlane> planes;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) planes.push_back(resolver.plane(0, i));
  fill(buffers_[2], planes);
  std::vector<Eigen::Vector4d> directions;
  for (const Eigen::Vector3d& d : beams.directions) directions.emplace_back(d.x(), d.y(), d.z(), 0);
  fill(buffers_[3], directions);
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    reach_[0] = std::max(reach_[0], 1.001F * p.cwiseAbs().maxCoeff());
    reach_[1] = std::max(reach_[1], 1.001F * p.norm());
  }
  opengl::check_gl("taking the scene into the graphics device's memory");
}

void ComputeScene::bind() const {
  for (GLuint i = 0; i < buffers_.size(); ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers_[i].name());
  }
  glUniform2uiv(0, 1, size_.data());
  glUniform4dv(1, 1, sphere_.data());
  glUniform2fv(2, 1, reach_.data());
}

}  // namespace glidar::bench

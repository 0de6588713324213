// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/scene_walk.hpp>

#include <glidar/io/model/mesh_blob.hpp>

#include <assimp/scene.h>

#include <fmt/format.h>

namespace glidar::import {
namespace {

constexpr std::uint64_t kMaxTriangles = 100'000'000;
constexpr std::uint64_t kMaxNodes = 10'000'000;

struct Visit {
  const aiNode* node;
  Eigen::Matrix4d model_from_parent;
};

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

void place_meshes(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& model_from_node,
                  Walk& walk) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] >= scene.mNumMeshes) continue;
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0U) {
      walk.lines_and_points += mesh.mNumFaces;
      continue;
    }
    walk.triangles += mesh.mNumFaces;
    walk.skinned += mesh.mNumBones > 0 ? 1 : 0;
    if (walk.triangles > kMaxTriangles || walk.placed.size() >= kMaxRecords) {
      throw Refusal{fmt::format("the instances in its tree have more than {} "
                                "triangles or {} parts",
                                kMaxTriangles, kMaxRecords),
                    "make the model smaller, or place its parts by a scene file"};
    }
    const aiString& name = mesh.mName.length > 0 ? mesh.mName : node.mName;
    walk.placed.push_back({&mesh, model_from_node, std::string(name.C_Str())});
  }
}

}  // namespace

Refusal no_triangles(const std::string& instead) {
  return {
      "no triangles" + instead,
      "GLIDAR needs surfaces: name a model with triangles or polygons (of a point cloud, make a "
      "mesh first)"};
}

Walk walk(const aiScene& scene, const NodeTransforms& transforms) {
  Walk result;
  // An explicit stack, because hostile trees are deep.
  std::vector<Visit> stack;
  if (scene.mRootNode != nullptr) stack.push_back({scene.mRootNode, Eigen::Matrix4d::Identity()});
  for (std::uint64_t visited = 0; !stack.empty(); ++visited) {
    if (visited > kMaxNodes) {
      throw Refusal{fmt::format("its tree has more than {} nodes", kMaxNodes),
                    "make the model smaller"};
    }
    const Visit visit = stack.back();
    stack.pop_back();
    const auto known = transforms.find(visit.node);
    const Eigen::Matrix4d model_from_node =
        visit.model_from_parent *
        (known == transforms.end() ? matrix(visit.node->mTransformation) : known->second);
    place_meshes(scene, *visit.node, model_from_node, result);
    for (unsigned child = visit.node->mNumChildren; child-- > 0;) {
      stack.push_back({visit.node->mChildren[child], model_from_node});
    }
  }
  if (result.triangles > 0) return result;
  throw no_triangles(result.lines_and_points > 0
                         ? fmt::format(", only {} points and lines", result.lines_and_points)
                         : "");
}

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf_transforms.hpp>

#include <import/gltf_file.hpp>

#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <set>
#include <string>
#include <vector>

namespace glidar::import {
namespace {

using Json = nlohmann::json;

/// Skips the parts that may be large: data in texts, tables of accessors.
Json parse_tree(std::string_view text) {
  static const std::set<std::string> kWanted = {"scene", "scenes", "nodes"};
  const auto keep = [](int depth, Json::parse_event_t event, const Json& parsed) {
    const bool is_top_key = depth == 1 && event == Json::parse_event_t::key;
    return !is_top_key || kWanted.contains(parsed.get<std::string>());
  };
  return Json::parse(text, keep, false);
}

/// `count` numbers, or none.
std::vector<double> read_numbers(const Json& node, const char* key, std::size_t count) {
  const auto found = node.find(key);
  if (found == node.end() || !found->is_array() || found->size() != count) return {};
  std::vector<double> numbers;
  for (const Json& number : *found) {
    if (!number.is_number()) return {};
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

Eigen::Matrix4d transform_of(const Json& node) {
  if (const std::vector<double> m = read_numbers(node, "matrix", 16); !m.empty()) {
    return Eigen::Map<const Eigen::Matrix4d>(m.data());  // column-major, as in Eigen
  }
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (const auto t = read_numbers(node, "translation", 3); !t.empty()) {
    transform.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  }
  if (const auto q = read_numbers(node, "rotation", 4); !q.empty()) {
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (rotation.norm() > 0.0) transform.rotate(rotation.normalized());
  }
  if (const auto s = read_numbers(node, "scale", 3); !s.empty()) {
    transform.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  }
  return transform.matrix();
}

/// Whether the importer has the same transform in single precision.
bool agrees(const Eigen::Matrix4d& exact, const aiMatrix4x4& single) {
  constexpr double kSingle = 1e-5;
  const Eigen::Matrix<float, 4, 4, Eigen::RowMajor> theirs =
      Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(&single.a1);
  const double largest = exact.cwiseAbs().maxCoeff();
  return exact.allFinite() &&
         (exact - theirs.cast<double>()).cwiseAbs().maxCoeff() <= kSingle * largest;
}

/// A node of the file and of the importer's scene.
struct Pair {
  std::size_t index;
  const aiNode* node;
};

/// Pairs the file's nodes of a list with the importer's; false if their numbers differ.
bool add_pairs(const Json& list, const aiNode* const* nodes, std::size_t count,
               std::vector<Pair>& pairs) {
  if (!list.is_array() || list.size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!list[i].is_number_unsigned()) return false;
    pairs.push_back({list[i].get<std::size_t>(), nodes[i]});
  }
  return true;
}

/// The roots of the default scene. One root is the importer's root itself, several are below it.
std::vector<Pair> roots_of(const Json& file, const aiNode& root) {
  std::vector<Pair> pairs;
  const auto scenes = file.find("scenes");
  const std::size_t index = file.value("scene", std::size_t{0});
  if (scenes == file.end() || !scenes->is_array() || index >= scenes->size()) return {};
  const Json& roots = (*scenes)[index].value("nodes", Json::array());
  const aiNode* const only = &root;
  const bool is_single = roots.size() == 1;
  const bool fits = is_single ? add_pairs(roots, &only, 1, pairs)
                              : add_pairs(roots, root.mChildren, root.mNumChildren, pairs);
  return fits ? pairs : std::vector<Pair>{};
}

NodeTransforms matched(const Json& file, const aiNode& root) {
  NodeTransforms transforms;
  const auto nodes = file.find("nodes");
  if (nodes == file.end() || !nodes->is_array()) return {};
  std::vector<Pair> pairs = roots_of(file, root);
  while (!pairs.empty()) {
    const Pair pair = pairs.back();
    pairs.pop_back();
    if (pair.index >= nodes->size() || transforms.contains(pair.node)) return {};
    const Json& node = (*nodes)[pair.index];
    if (!node.is_object()) return {};
    const Eigen::Matrix4d exact = transform_of(node);
    if (!agrees(exact, pair.node->mTransformation)) continue;
    transforms.emplace(pair.node, exact);
    const auto children = node.find("children");
    if (children == node.end()) continue;
    add_pairs(*children, pair.node->mChildren, pair.node->mNumChildren, pairs);
  }
  return transforms;
}

}  // namespace

NodeTransforms gltf_transforms(std::string_view file, const aiScene& scene) {
  if (scene.mRootNode == nullptr) return {};
  try {
    const Json tree = parse_tree(gltf_json(file));
    return tree.is_object() ? matched(tree, *scene.mRootNode) : NodeTransforms{};
  } catch (const Json::exception&) {
    return {};  // a value of an invalid type: keeps the importer's transforms
  }
}

}  // namespace glidar::import

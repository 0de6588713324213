// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/nodes.hpp>

#include <import/gltf/accessors.hpp>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <string>

namespace glidar::import::gltf {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

Eigen::Matrix4d parent_from_node(const Value& node, Notes& notes) {
  const Value matrix = node["matrix"];
  const Value translation = node["translation"];
  const Value rotation = node["rotation"];
  const Value scale = node["scale"];
  if (matrix) {
    if (translation || rotation || scale) matrix.refuse("translation, rotation or scale beside it");
    const std::vector<double> numbers = matrix.numbers(16);
    return affine(numbers.data(), matrix, "its last row", notes);
  }
  const std::vector<double> t = translation.numbers_or({0, 0, 0});
  const std::vector<double> q = rotation.numbers_or({0, 0, 0, 1});
  const std::vector<double> s = scale.numbers_or({1, 1, 1});
  if (Eigen::Map<const Eigen::Vector4d>(q.data()).isZero(0.0)) rotation.refuse("all are 0");
  return composed(Eigen::Map<const Eigen::Vector3d>(t.data()),
                  Eigen::Map<const Eigen::Vector4d>(q.data()),
                  Eigen::Map<const Eigen::Vector3d>(s.data()));
}

/// Children of every node; each has one parent at most.
struct Family {
  std::vector<std::vector<std::size_t>> children;
  std::vector<std::size_t> parent;
};

void add_child(Family& family, std::size_t parent, std::size_t child, const Value& index) {
  if (family.parent[child] != kNoNode) {
    index.refuse(
        fmt::format("nodes[{}] has another parent, nodes[{}]", child, family.parent[child]));
  }
  family.parent[child] = parent;
  family.children[parent].push_back(child);
}

Family read_family(const Document& document) {
  const Value nodes = document.root()["nodes"];
  Family family{std::vector<std::vector<std::size_t>>(nodes.size()),
                std::vector<std::size_t>(nodes.size(), kNoNode)};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Value list = nodes.at(i)["children"];
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Value index = list.at(k);
      add_child(family, i, document.number("nodes", index), index);
    }
  }
  return family;
}

/// All nodes below the roots, depth first, parents first.
std::vector<std::size_t> below(const std::vector<std::size_t>& roots, const Family& family) {
  std::vector<std::size_t> order;
  std::vector<std::size_t> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const std::size_t node = stack.back();
    stack.pop_back();
    order.push_back(node);
    const std::vector<std::size_t>& children = family.children[node];
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return order;
}

std::vector<std::size_t> without_parent(const Family& family) {
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < family.parent.size(); ++i) {
    if (family.parent[i] == kNoNode) roots.push_back(i);
  }
  return roots;
}

/// The roots of the scene that is loaded.
std::vector<std::size_t> roots_of_scene(Document& document, const Family& family) {
  const Value scenes = document.root()["scenes"];
  const Value chosen = document.root()["scene"];
  if (!chosen && scenes.size() == 0) return without_parent(family);
  const Value scene = chosen ? document.target("scenes", chosen) : scenes.at(0);
  if (scenes.size() > 1) {
    document.notes.add(fmt::format("{} of {} scenes is loaded: {}", scene.path(), scenes.size(),
                                   chosen ? "it is the default" : "the file names no default"));
  }
  std::vector<std::size_t> roots;
  const Value list = scene["nodes"];
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Value index = list.at(k);
    const std::size_t root = document.number("nodes", index);
    if (family.parent[root] != kNoNode) {
      index.refuse(
          fmt::format("nodes[{}] is no root, its parent is nodes[{}]", root, family.parent[root]));
    }
    if (std::find(roots.begin(), roots.end(), root) != roots.end()) index.refuse("it occurs twice");
    roots.push_back(root);
  }
  return roots;
}

/// Drops nodes that KHR_node_visibility hides, and those below them.
void drop_hidden(Document& document, const Family& family, std::vector<std::size_t>& order) {
  const Value nodes = document.root()["nodes"];
  std::vector<bool> hidden(nodes.size(), false);
  std::size_t count = 0;
  for (const std::size_t i : order) {
    const std::size_t parent = family.parent[i];
    const bool is_visible = nodes.at(i).extension("KHR_node_visibility")["visible"].flag_or(true);
    hidden[i] = !is_visible || (parent != kNoNode && hidden[parent]);
    count += hidden[i] ? 1 : 0;
  }
  if (count == 0) return;
  order.erase(std::remove_if(order.begin(), order.end(), [&](std::size_t i) { return hidden[i]; }),
              order.end());
  document.notes.add(fmt::format("{} nodes are hidden by KHR_node_visibility: left out", count));
}

void note_outside(Document& document, const std::vector<std::size_t>& in_scene) {
  const Value nodes = document.root()["nodes"];
  std::vector<bool> is_inside(nodes.size(), false);
  for (const std::size_t i : in_scene) is_inside[i] = true;
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    count += !is_inside[i] && nodes.at(i)["mesh"] ? 1 : 0;
  }
  if (count == 0) return;
  document.notes.add(fmt::format("{} nodes with meshes are not in the scene: left out", count));
}

/// Rows of an attribute of the copies; `fallback` for each if it is absent.
std::vector<Eigen::VectorXd> rows_of(const Value& index, std::size_t components,
                                     const Eigen::VectorXd& fallback, std::size_t count,
                                     Document& document, Buffers& buffers) {
  if (!index) return std::vector<Eigen::VectorXd>(count, fallback);
  const Accessor accessor = open_accessor(document, buffers, index);
  if (accessor.components != components) {
    index.refuse(fmt::format("{} components, {} are needed", accessor.components, components));
  }
  if (accessor.count != count) index.refuse("the attributes of the copies differ in number");
  const std::vector<double> numbers = read_numbers(accessor, document.notes);
  std::vector<Eigen::VectorXd> rows;
  for (std::size_t i = 0; i < count; ++i) {
    rows.emplace_back(Eigen::Map<const Eigen::VectorXd>(numbers.data() + i * components,
                                                        static_cast<Eigen::Index>(components)));
  }
  return rows;
}

}  // namespace

Eigen::Matrix4d affine(const double* by_columns, const Value& where, const std::string& row,
                       Notes& notes) {
  constexpr double kRounding = 1e-5;  // exporters invert matrices in single precision
  Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(by_columns);
  const Eigen::RowVector4d last(0, 0, 0, 1);
  const double difference = (matrix.row(3) - last).cwiseAbs().maxCoeff();
  if (!(difference <= kRounding)) where.refuse(row + " is not 0, 0, 0, 1: no affine transform");
  if (difference > 0) {
    notes.add_at(where.path(), "the last row of a matrix is rounded: read as 0, 0, 0, 1");
  }
  matrix.row(3) = last;
  return matrix;
}

Eigen::Matrix4d composed(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
                         const Eigen::Vector3d& scale) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  const Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
  matrix.topLeftCorner<3, 3>() = turn.normalized().toRotationMatrix() * scale.asDiagonal();
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

Nodes read_nodes(Document& document) {
  const Value nodes = document.root()["nodes"];
  const Family family = read_family(document);
  Nodes result;
  result.scene_from_node.resize(nodes.size());
  std::vector<bool> is_placed(nodes.size(), false);
  for (const std::size_t i : below(without_parent(family), family)) {
    const Eigen::Matrix4d local = parent_from_node(nodes.at(i), document.notes);
    const std::size_t parent = family.parent[i];
    result.scene_from_node[i] =
        parent == kNoNode ? local : Eigen::Matrix4d(result.scene_from_node[parent] * local);
    is_placed[i] = true;
  }
  const auto loop = std::find(is_placed.begin(), is_placed.end(), false);
  if (loop != is_placed.end()) {
    nodes.at(static_cast<std::size_t>(loop - is_placed.begin()))
        .refuse("the node is below itself: a cycle");
  }
  result.shown = below(roots_of_scene(document, family), family);
  note_outside(document, result.shown);
  drop_hidden(document, family, result.shown);
  result.parent = family.parent;
  return result;
}

std::size_t count_copies(const Document& document, const Value& node) {
  const Value extension = node.extension(kInstancing);
  if (!extension) return 1;
  const Value attributes = extension.required("attributes");
  if (attributes.members().empty()) attributes.refuse("copies need an attribute");
  return describe_accessor(document.target("accessors", attributes.members().back().second)).count;
}

std::vector<Eigen::Matrix4d> copies_of(Document& document, Buffers& buffers, const Value& node) {
  if (!node.extension(kInstancing)) return {Eigen::Matrix4d::Identity()};
  const Value attributes = node.extension(kInstancing)["attributes"];
  const std::size_t count = count_copies(document, node);
  for (const auto& [name, index] : attributes.members()) {
    const bool is_used = name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
    if (is_used) continue;
    document.notes.add("attributes of copies are left out: " + name.substr(0, 80));
  }
  const auto rows = [&](const char* name, std::size_t components, const Eigen::VectorXd& fallback) {
    return rows_of(attributes[name], components, fallback, count, document, buffers);
  };
  const auto translations = rows("TRANSLATION", 3, Eigen::Vector3d::Zero());
  const auto rotations = rows("ROTATION", 4, Eigen::Vector4d::UnitW());
  const auto scales = rows("SCALE", 3, Eigen::Vector3d::Ones());
  std::vector<Eigen::Matrix4d> copies;
  for (std::size_t i = 0; i < count; ++i) {
    if (rotations[i].isZero(0.0))
      attributes["ROTATION"].refuse(fmt::format("copy {}: all are 0", i));
    copies.push_back(composed(translations[i], rotations[i], scales[i]));
  }
  return copies;
}

}  // namespace glidar::import::gltf

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/read_gltf.hpp>

#include <import/gltf/accessors.hpp>
#include <import/gltf/draco.hpp>
#include <import/gltf/materials.hpp>
#include <import/gltf/nodes.hpp>
#include <import/gltf/primitive.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace glidar::import::gltf {
namespace {

/// Weights of the morph targets of a mesh at a node: the node's own, else the mesh's, else 0.
std::vector<double> weights_of(const Value& node, const Value& mesh, const Value& targets) {
  const Value own = node["weights"];
  const Value weights = own ? own : mesh["weights"];
  if (!weights) return std::vector<double>(targets.size(), 0.0);
  return weights.numbers(targets.size());
}

/// scene_from_joint times the inverse bind matrix, of each joint of a skin (glTF 2.0, 3.7.3.2).
std::vector<Eigen::Matrix4d> joints_of(const Context& context, const Value& skin,
                                       const Nodes& nodes) {
  const Value list = skin.required("joints");
  if (list.size() == 0) list.refuse("a skin needs a joint");
  std::vector<Eigen::Matrix4d> joints;
  for (std::size_t i = 0; i < list.size(); ++i) {
    joints.push_back(nodes.scene_from_node[context.document.number("nodes", list.at(i))]);
  }
  const Value index = skin["inverseBindMatrices"];
  if (!index) return joints;
  const Accessor accessor = open_accessor(context.document, context.buffers, index);
  if (accessor.components != 16 || accessor.type != Component::float32) {
    index.refuse("it is not of the type MAT4 of floats");
  }
  if (accessor.count < joints.size()) {
    index.refuse(fmt::format("{} matrices for {} joints", accessor.count, joints.size()));
  }
  const std::vector<double> numbers = read_numbers(accessor, context.model.notes);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string row = fmt::format("the last row of matrix {}", i);
    joints[i] = joints[i] * affine(numbers.data() + i * 16, index, row, context.model.notes);
  }
  return joints;
}

/// What the document states about a primitive that is read.
struct StatedPrimitive {
  std::uint64_t faces = 0;
  Eigen::AlignedBox3d box;  ///< by the limits of its positions; empty: it states none
};

/// The box that the limits of positions state, and a mesh has that nothing deforms.
Eigen::AlignedBox3d stated_box(const Value& primitive, const Accessor& positions) {
  Eigen::AlignedBox3d box;
  const bool is_stated = positions.min.size() == 3 && positions.max.size() == 3;
  if (!is_stated || primitive["targets"] || primitive.extension(kDracoExtension)) return box;
  const double one = positions.normalized ? largest_of(positions.type) : 1.0;
  box.extend(Eigen::Vector3d(positions.min.data()) / one);
  box.extend(Eigen::Vector3d(positions.max.data()) / one);
  return box;
}

StatedPrimitive stated_by(const Document& document, const Value& primitive) {
  const Value index = primitive["attributes"]["POSITION"];
  if (!index) return {};
  const Accessor positions = describe_accessor(document.target("accessors", index));
  const Value indices = primitive["indices"];
  const std::size_t corners =
      indices ? describe_accessor(document.target("accessors", indices)).count : positions.count;
  const bool is_list = primitive["mode"].count_or(Mode::triangles) == Mode::triangles ||
                       primitive.extension(kDracoExtension);
  return {is_list ? corners / 3 : std::max<std::size_t>(corners, 2) - 2,
          stated_box(primitive, positions)};
}

/// Whether a box stays the bounding box of its content: axes become axes.
bool keeps_boxes(const Eigen::Matrix4d& matrix) {
  for (int row = 0; row < 3; ++row) {
    if ((matrix.row(row).head<3>().array() != 0.0).count() > 1) return false;
  }
  return true;
}

/// Adds up what the document states about the instances that the model has.
class StatedContent {
 public:
  /// Each primitive once.
  void add_vertices(const Document& document, const Value& primitive, const SourceMesh& mesh) {
    const Value index = primitive["attributes"]["POSITION"];
    const std::size_t number = document.number("accessors", index);
    std::vector<bool>& used = used_[number];
    used.resize(std::max({used.size(), mesh.positions.size(),
                          document.target("accessors", index).required("count").count()}));
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) used[corner] = true;
    }
  }

  void add_instance(const StatedPrimitive& stated, const Eigen::Matrix4d& matrix) {
    faces_ += stated.faces;
    ++instances_;
    has_box_ = has_box_ && !stated.box.isEmpty() && keeps_boxes(matrix);
    if (!has_box_) return;
    for (const Eigen::Vector3d& corner : {stated.box.min(), stated.box.max()}) {
      box_.extend((matrix * corner.homogeneous()).head<3>());
    }
  }

  void finish(SourceModel& model) const {
    model.stated.vertices = model.used_vertices = 0;
    for (const auto& [number, used] : used_) {
      *model.stated.vertices += used.size();
      *model.used_vertices +=
          static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
    }
    model.stated.faces = faces_;
    model.stated.instances = instances_;
    if (has_box_) model.stated.bounds = box_;
  }

 private:
  std::map<std::size_t, std::vector<bool>> used_;  ///< of each accessor of positions
  std::uint64_t faces_ = 0;
  std::uint64_t instances_ = 0;
  Eigen::AlignedBox3d box_;
  bool has_box_ = true;
};

/// Places the meshes of nodes in the model.
class Placement {
 public:
  Placement(Context& context, const Nodes& nodes)
      : context_(context), nodes_(nodes), part_of_node_(nodes.parent.size(), 0) {}

  /// Places a node; its parent first.
  void place(std::size_t number) {
    const Value node = context_.document.root()["nodes"].at(number);
    add_part(number, node);
    const Value skin = node["skin"];
    if (!node["mesh"]) {
      if (skin) skin.refuse("a node without a mesh has a skin");
      return;
    }
    const Value mesh = context_.document.target("meshes", node["mesh"]);
    const std::vector<Part>& parts = meshes_of(node, mesh);
    context_.model.take_instances(count_copies(context_.document, node) * parts.size());
    const std::vector<Eigen::Matrix4d> copies =
        copies_of(context_.document, context_.buffers, node);
    if (skin && node.extension("EXT_mesh_gpu_instancing")) {
      node.refuse("copies of a mesh with a skin (EXT_mesh_gpu_instancing)");
    }
    std::string name = mesh["name"].text_or("");
    if (name.empty()) name = node["name"].text_or("");
    if (name.empty()) name = mesh.path();
    std::vector<SourceNode>& parts_of_model = context_.model.nodes;
    for (std::size_t i = 0; i < copies.size(); ++i) {
      const Eigen::Matrix4d scene_from_copy = nodes_.scene_from_node[number] * copies[i];
      std::uint32_t of = part_of_node_[number];
      if (copies.size() > 1) {
        of = add_node(parts_of_model, std::to_string(i + 1), of, scene_from_copy);
      }
      // The skeleton places a mesh with a skin.
      const Eigen::Matrix4d matrix =
          skin ? Eigen::Matrix4d(Eigen::Matrix4d::Identity()) : scene_from_copy;
      for (const Part& part : parts) {
        context_.model.place({part.mesh, matrix, name, of});
        content_.add_instance(part.stated, matrix);
      }
    }
  }

  void finish() { content_.finish(context_.model); }

 private:
  struct Part {
    std::size_t mesh = 0;
    StatedPrimitive stated;
  };

  /// A node without a name has that of its mesh; without either it is no part.
  void add_part(std::size_t number, const Value& node) {
    std::string name = node["name"].text_or("");
    if (name.empty() && node["mesh"]) {
      name = context_.document.target("meshes", node["mesh"])["name"].text_or("");
      if (name.empty()) name = fmt::format("node_{}", number);
    }
    const std::size_t parent = nodes_.parent[number];
    part_of_node_[number] =
        add_node(context_.model.nodes, name, parent == kNoNode ? 0 : part_of_node_[parent],
                 nodes_.scene_from_node[number]);
  }

  /// The primitives of a mesh as the node shows them; read once for nodes that show them alike.
  const std::vector<Part>& meshes_of(const Value& node, const Value& mesh) {
    const bool is_own = node["skin"] || node["weights"];
    const auto key = std::pair(mesh.path(), is_own ? node.path() : std::string());
    const auto [known, is_new] = read_.try_emplace(key);
    if (!is_new) return known->second;
    const Value primitives = mesh.required("primitives");
    if (primitives.size() == 0) primitives.refuse("a mesh needs a primitive");
    Deformation deformation;
    if (node["skin"]) {
      const Value skin = context_.document.target("skins", node["skin"]);
      deformation.joints = joints_of(context_, skin, nodes_);
    }
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const Value primitive = primitives.at(i);
      deformation.weights = weights_of(node, mesh, primitive["targets"]);
      auto part = read_primitive(context_, primitive, deformation);
      if (!part) continue;
      content_.add_vertices(context_.document, primitive, *part);
      StatedPrimitive stated = stated_by(context_.document, primitive);
      if (node["skin"]) stated.box.setEmpty();
      known->second.push_back({context_.model.meshes.size(), stated});
      context_.model.meshes.push_back(std::move(*part));
    }
    return known->second;
  }

  Context& context_;
  const Nodes& nodes_;
  std::vector<std::uint32_t> part_of_node_;  ///< index into SourceModel::nodes
  std::map<std::pair<std::string, std::string>, std::vector<Part>> read_;
  StatedContent content_;
};

}  // namespace

bool is_gltf(std::string_view extension, std::string_view first_bytes) {
  return extension == ".gltf" || extension == ".glb" || extension == ".vrm" ||
         first_bytes.starts_with("glTF");
}

SourceModel read_gltf(std::string_view file, OpenFile open) {
  Document document = parse(file);
  SourceModel model;
  model.budget.add_input(file.size());
  Buffers buffers(document, std::move(open), model.budget);
  model.format = "glTF2";
  model.declared = {1.0, Axis::y};
  std::vector<UvSets> uv_sets = read_materials(document, buffers, model);
  Context context{document, buffers, model, std::move(uv_sets)};
  const Nodes nodes = read_nodes(document);
  Placement placement(context, nodes);
  for (const std::size_t node : nodes.shown) placement.place(node);
  placement.finish();
  document.notes.add(model.notes);
  model.notes = std::move(document.notes);
  return model;
}

}  // namespace glidar::import::gltf

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/primitive.hpp>

#include <import/gltf/draco.hpp>
#include <import/skin.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace glidar::import::gltf {
namespace {

/// What an attribute may be made of.
struct Kind {
  std::size_t components = 0;
  bool is_fraction = false;  ///< integers must be normalized
};

class PrimitiveReader {
 public:
  PrimitiveReader(Context& context, const Value& primitive)
      : context_(context), primitive_(primitive), attributes_(primitive.required("attributes")) {
    if (primitive.extension(kDracoExtension)) {
      draco_ = decode_draco(context.document, context.buffers, primitive);
    }
  }

  /// Number of vertices; 0 without positions.
  std::size_t count_vertices() {
    const Value index = attributes_["POSITION"];
    if (!index) return 0;
    vertices_ = open("POSITION", index).count;
    return vertices_;
  }

  /// The components of an attribute; none if it is absent.
  std::vector<double> numbers(const std::string& name, const Kind& kind) {
    const Value index = attributes_[name.c_str()];
    return index ? numbers_of(open(name, index), index, kind) : std::vector<double>{};
  }

  /// The same of a morph target.
  std::vector<double> deltas(const Value& target, const char* name, const Kind& kind) {
    const Value index = target[name];
    if (!index) return {};
    return numbers_of(open_accessor(context_.document, context_.buffers, index), index, kind);
  }

  std::vector<std::uint32_t> joints(const std::string& name) {
    const Value index = attributes_[name.c_str()];
    const Accessor accessor = open(name, index);
    check_shape(accessor, index, 4);
    return read_integers(accessor, context_.model.notes);
  }

  /// The corners of all triangles, lines or points.
  std::vector<std::uint32_t> corners() {
    if (draco_) return checked(std::move(draco_->corners), primitive_);
    const Value index = primitive_["indices"];
    if (!index) {
      std::vector<std::uint32_t> all(vertices_);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
      return all;
    }
    const Accessor accessor = open_accessor(context_.document, context_.buffers, index);
    if (accessor.components != 1) index.refuse("indices are of the type SCALAR");
    return checked(read_integers(accessor, context_.model.notes), index);
  }

  [[nodiscard]] std::size_t mode() const {
    const Value value = primitive_["mode"];
    const std::size_t mode = value.count_or(Mode::triangles);
    if (mode > Mode::fan) value.refuse(fmt::format("{} is no mode (allowed: 0 to 6)", mode));
    return draco_ ? std::size_t{Mode::triangles} : mode;
  }

  [[nodiscard]] const Value& attributes() const { return attributes_; }

 private:
  Accessor open(const std::string& name, const Value& index) {
    if (draco_ && draco_->views.contains(name)) return draco_->views.at(name);
    Accessor accessor = open_accessor(context_.document, context_.buffers, index);
    accessor.needs_limits = name == "POSITION";
    return accessor;
  }

  void check_shape(const Accessor& accessor, const Value& index, std::size_t components) const {
    if (accessor.components != components) {
      index.refuse(fmt::format("{} has {} components, {} are needed", accessor.path,
                               accessor.components, components));
    }
    if (accessor.count != vertices_) {
      index.refuse(fmt::format("{} has {} elements for {} vertices", accessor.path, accessor.count,
                               vertices_));
    }
  }

  std::vector<double> numbers_of(const Accessor& accessor, const Value& index, const Kind& kind) {
    // Colours may have an alpha.
    const bool has_alpha = kind.components == 3 && kind.is_fraction && accessor.components == 4;
    check_shape(accessor, index, has_alpha ? 4 : kind.components);
    const bool is_integer = accessor.type != Component::float32;
    if (accessor.type == Component::uint32 ||
        (is_integer && kind.is_fraction && !accessor.normalized)) {
      refuse(accessor.path + ".componentType",
             "integers that are not normalized, of " + index.path());
    }
    return read_numbers(accessor, context_.model.notes);
  }

  std::vector<std::uint32_t> checked(std::vector<std::uint32_t> all, const Value& where) const {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i] < vertices_) continue;
      where.refuse(fmt::format("index {} names vertex {} of {}", i, all[i], vertices_));
    }
    return all;
  }

  Context& context_;
  Value primitive_;
  Value attributes_;
  std::size_t vertices_ = 0;
  std::optional<DracoMesh> draco_;
};

template <class V>
std::vector<V> vectors_of(const std::vector<double>& numbers, std::size_t stride) {
  constexpr std::size_t kSize = V::RowsAtCompileTime;
  std::vector<V> all(numbers.size() / stride);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < kSize; ++k) {
      all[i][static_cast<Eigen::Index>(k)] =
          static_cast<typename V::Scalar>(numbers[i * stride + k]);
    }
  }
  return all;
}

// Morphing.

struct Morphs {
  Value targets;
  const std::vector<double>& weights;  ///< one per target
};

/// Adds the weighted differences of all targets to an attribute.
void morph(PrimitiveReader& reader, const Morphs& morphs, const char* name, const Kind& kind,
           std::vector<double>& values, std::size_t stride) {
  if (values.empty()) return;
  for (std::size_t t = 0; t < morphs.targets.size(); ++t) {
    if (morphs.weights[t] == 0.0) continue;
    const std::vector<double> deltas = reader.deltas(morphs.targets.at(t), name, kind);
    const std::size_t n = deltas.size() / (values.size() / stride);
    for (std::size_t i = 0; i < deltas.size(); ++i) {
      values[i / n * stride + i % n] += morphs.weights[t] * deltas[i];
    }
  }
}

// Skinning.

/// The pose of a joint times its weight.
Eigen::Matrix4d weighted_joint(const Value& primitive, const Deformation& deformation,
                               std::size_t vertex, std::uint32_t joint, double weight) {
  if (joint >= deformation.joints.size() || !(weight >= 0.0)) {
    primitive.refuse(fmt::format("vertex {} has the joint {} of {} and the weight {}", vertex,
                                 joint, deformation.joints.size(), weight));
  }
  return weight * deformation.joints[joint];
}

/// The matrix of each vertex.
std::vector<Eigen::Matrix4d> skin_of(PrimitiveReader& reader, const Value& primitive,
                                     const Deformation& deformation, std::size_t vertices,
                                     SourceModel& model) {
  std::vector<Eigen::Matrix4d> skin(vertices, Eigen::Matrix4d::Zero());
  std::vector<double> sums(vertices, 0.0);
  for (std::size_t set = 0; reader.attributes()[("JOINTS_" + std::to_string(set)).c_str()]; ++set) {
    const std::string number = std::to_string(set);
    const std::vector<std::uint32_t> joints = reader.joints("JOINTS_" + number);
    const std::vector<double> weights = reader.numbers("WEIGHTS_" + number, {4, true});
    reader.attributes()[("WEIGHTS_" + number).c_str()].require();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (weights[i] == 0.0) continue;
      skin[i / 4] += weighted_joint(primitive, deformation, i / 4, joints[i], weights[i]);
      sums[i / 4] += weights[i];
    }
  }
  constexpr double kNearOne = 0.01;
  bool is_scaled = false;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (sums[v] == 0.0) primitive.refuse(fmt::format("vertex {} has no joint with a weight", v));
    skin[v] /= sums[v];
    is_scaled = is_scaled || std::abs(sums[v] - 1.0) > kNearOne;
  }
  if (is_scaled) {
    model.notes.add(primitive.path() + ": weights of joints do not add to 1, they are scaled");
  }
  return skin;
}

// Triangles.

/// glTF 2.0, 3.7.2.1. Corners that are left over form no triangle.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& corners, std::size_t mode) {
  std::vector<Triangle> all;
  const std::size_t n = corners.size();
  if (mode == Mode::triangles) {
    all.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) {
      all.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    return all;
  }
  for (std::size_t i = 0; i + 2 < n; ++i) {
    if (mode == Mode::strip) {
      all.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    } else {
      all.push_back({corners[i + 1], corners[i + 2], corners[0]});
    }
  }
  return all;
}

std::uint64_t lines_or_points(std::size_t corners, std::size_t mode) {
  switch (mode) {
    case Mode::lines:
      return corners / 2;
    case Mode::line_strip:
      return corners - std::min<std::size_t>(corners, 1);
    default:
      return corners;
  }
}

void note_leftover(const Value& primitive, std::size_t corners, std::size_t mode,
                   SourceModel& model) {
  const bool is_short = mode != Mode::triangles && corners < 3;
  const std::size_t left = mode == Mode::triangles ? corners % 3 : is_short ? corners : 0;
  if (left == 0) return;
  model.notes.add(fmt::format("{}: {} corners form no triangle: left out", primitive.path(), left));
}

/// Notes attributes that nothing here reads.
void note_attributes(const Value& primitive, const Value& attributes, const UvSets& sets,
                     bool is_skinned, SourceModel& model) {
  for (const auto& [name, index] : attributes.members()) {
    static constexpr std::array<std::string_view, 4> kRead = {"POSITION", "NORMAL", "TANGENT",
                                                              "COLOR_0"};
    bool is_read = std::find(kRead.begin(), kRead.end(), name) != kRead.end();
    for (const std::size_t set : sets.sets) {
      is_read = is_read || name == "TEXCOORD_" + std::to_string(set);
    }
    const bool is_skin = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
    if (is_read || (is_skin && is_skinned)) continue;
    model.notes.add(is_skin ? "joints of a mesh without a skin are left out"
                            : "attributes are left out: " + name.substr(0, 80));
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = "TEXCOORD_" + std::to_string(sets.sets[k]);
    if (!sets.needed[k] || attributes[name.c_str()]) continue;
    model.notes.add(
        fmt::format("{} has no {}, which a texture of its material needs: (0, 0) is "
                    "assumed",
                    primitive.path(), name));
  }
}

void read_uvs(PrimitiveReader& reader, const UvSets& sets, const Morphs& morphs, SourceMesh& mesh) {
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = "TEXCOORD_" + std::to_string(sets.sets[k]);
    std::vector<double> uvs = reader.numbers(name, {2, false});
    morph(reader, morphs, name.c_str(), {2, false}, uvs, 2);
    mesh.uvs[k] = vectors_of<Eigen::Vector2f>(uvs, 2);
    for (Eigen::Vector2f& uv : mesh.uvs[k]) uv.y() = 1.0F - uv.y();
  }
}

void read_colours(PrimitiveReader& reader, const Morphs& morphs, SourceMesh& mesh,
                  SourceModel& model) {
  std::vector<double> colours = reader.numbers("COLOR_0", {3, true});
  if (colours.empty()) return;
  const std::size_t n = colours.size() / mesh.positions.size();
  morph(reader, morphs, "COLOR_0", {3, true}, colours, n);
  mesh.colours = vectors_of<Eigen::Vector3f>(colours, n);
  for (std::size_t i = 3; n == 4 && i < colours.size(); i += 4) {
    if (colours[i] < 1.0) model.notes.add("the opacity of vertex colours is left out");
  }
}

}  // namespace

std::optional<SourceMesh> read_primitive(Context& context, const Value& primitive,
                                         const Deformation& deformation) {
  PrimitiveReader reader(context, primitive);
  SourceModel& model = context.model;
  const std::size_t vertices = reader.count_vertices();
  if (vertices == 0) {
    model.notes.add(primitive.path() + " has no vertices: left out");
    return std::nullopt;
  }
  std::vector<std::uint32_t> corners = reader.corners();
  const std::size_t mode = reader.mode();
  if (mode < Mode::triangles) {
    model.lines_and_points += lines_or_points(corners.size(), mode);
    return std::nullopt;
  }
  SourceMesh mesh;
  mesh.material = context.model.materials.size() - 1;
  if (primitive["material"]) {
    mesh.material = context.document.number("materials", primitive["material"]);
  }
  const UvSets& sets = context.uv_sets.at(mesh.material);
  const bool is_skinned = !deformation.joints.empty();
  note_attributes(primitive, reader.attributes(), sets, is_skinned, model);
  note_leftover(primitive, corners.size(), mode, model);
  mesh.triangles = triangles_of(corners, mode);
  free_memory(corners);
  const Morphs morphs{primitive["targets"], deformation.weights};
  const auto morphed = [&](const char* name, std::size_t components) {
    std::vector<double> values = reader.numbers(name, {components, false});
    morph(reader, morphs, name, {3, false}, values, components);
    return values;
  };
  mesh.positions = vectors_of<Eigen::Vector3d>(morphed("POSITION", 3), 3);
  mesh.normals = vectors_of<Eigen::Vector3f>(morphed("NORMAL", 3), 3);
  mesh.tangents = vectors_of<Eigen::Vector4f>(morphed("TANGENT", 4), 4);
  read_uvs(reader, sets, morphs, mesh);
  read_colours(reader, morphs, mesh, model);
  if (is_skinned) apply_skin(skin_of(reader, primitive, deformation, vertices, model), mesh);
  return mesh;
}

}  // namespace glidar::import::gltf

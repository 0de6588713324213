// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/mesh_blob.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/model/model_parts.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <type_traits>

namespace glidar {
namespace {

// One list of fields for both directions: `visit(archive, field)` with an archive that either
// writes bytes from the field or reads them into it.

struct Out {
  static constexpr bool kReads = false;
  BlockWriter& block;
  void raw(const void* data, std::size_t size) { block.bytes(data, size); }
};

struct In {
  static constexpr bool kReads = true;
  BlockReader& block;
  void raw(void* data, std::size_t size) { block.bytes(data, size); }
};

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T, class Wanted>
concept Is = std::is_same_v<std::remove_const_t<T>, Wanted>;

template <class A, class T>
requires Scalar<std::remove_const_t<T>>
void visit(A& archive, T& value) {
  archive.raw(&value, sizeof value);
}

/// Elements of plain numbers: their memory representation.
template <class T>
inline constexpr bool kPlain = std::is_arithmetic_v<T>;
template <class T, int R, int C>
inline constexpr bool kPlain<Eigen::Matrix<T, R, C>> = true;
template <>
inline constexpr bool kPlain<Triangle> = true;

template <class A, class T, int R, int C>
void visit(A& archive, Eigen::Matrix<T, R, C>& value) {
  archive.raw(value.data(), sizeof(T) * static_cast<std::size_t>(R * C));
}
template <class A, class T, int R, int C>
void visit(A& archive, const Eigen::Matrix<T, R, C>& value) {
  archive.raw(value.data(), sizeof(T) * static_cast<std::size_t>(R * C));
}

template <class A, class T>
requires Is<T, std::string>
void visit(A& archive, T& text) {
  std::uint64_t size = text.size();
  visit(archive, size);
  if constexpr (A::kReads) {
    if (size > archive.block.remaining()) reject_imported_data("a string longer than the data");
    text.resize(size);
  }
  archive.raw(text.data(), size);
}

template <class A, class T>
requires Is<T, std::optional<double>> || Is<T, std::optional<Axis>> ||
    Is<T, std::optional<std::uint64_t>>
void visit(A& archive, T& value) {
  std::uint8_t is_there = value.has_value() ? 1 : 0;
  visit(archive, is_there);
  if (is_there == 0) return;
  if constexpr (A::kReads) value.emplace();
  visit(archive, *value);
}

template <class T>
inline constexpr bool kVector = false;
template <class T>
inline constexpr bool kVector<std::vector<T>> = true;

template <class A, class V>
requires kVector<std::remove_const_t<V>>
void visit(A& archive, V& values) {
  using T = typename V::value_type;
  std::uint64_t size = values.size();
  visit(archive, size);
  if constexpr (A::kReads) {
    // A record starts with the length of a string, and needs more memory than bytes: a small limit
    // for them.
    const std::uint64_t each = kPlain<T> ? sizeof(T) : sizeof(std::uint64_t);
    if (size > archive.block.remaining() / each || (!kPlain<T> && size > kMaxRecords)) {
      reject_imported_data("an array longer than the data");
    }
    values.resize(size);
  }
  if constexpr (kPlain<T>) {
    if (!values.empty()) archive.raw(values.data(), values.size() * sizeof(T));
  } else {
    for (auto& value : values) visit(archive, value);
  }
}

// The fields of every record, in the order of the layout.

auto fields(Is<Texture> auto& t) {
  return std::tie(t.name, t.width, t.height, t.channels, t.texels);
}

auto fields(Is<TextureUse> auto& use) {
  return std::tie(use.texture, use.uv_set, use.wrap_u, use.wrap_v, use.filter, use.uv_scale_rotate,
                  use.uv_offset);
}

auto fields(Is<Material> auto& m) {
  return std::tie(m.name, m.ambient, m.diffuse, m.specular, m.shininess, m.opacity, m.alpha_cutoff,
                  m.normal_scale, m.diffuse_texture, m.specular_texture, m.alpha_texture,
                  m.normal_texture);
}

auto fields(Is<MeshOrigin> auto& o) {
  return std::tie(o.first_vertex, o.first_triangle, o.origin_m);
}

auto fields(Is<Mesh> auto& m) {
  return std::tie(m.name, m.origin_m, m.positions_m, m.normals, m.uvs[0], m.uvs[1], m.tangents,
                  m.colours, m.triangles, m.material_slots, m.origins);
}

auto fields(Is<ModelFrame> auto& frame) {
  return std::tie(frame.metres_per_unit, frame.up);
}

auto fields(Is<ModelContent> auto& content) {
  return std::tie(content.vertices, content.faces, content.instances, content.bounds.min(),
                  content.bounds.max());
}

auto fields(Is<ModelPart> auto& part) {
  return std::tie(part.name, part.first_triangle, part.triangle_count, part.node);
}

auto fields(Is<ModelNode> auto& node) {
  return std::tie(node.name, node.parent, node.model_from_node.matrix());
}

auto fields(Is<MissingTexture> auto& missing) {
  return std::tie(missing.name, missing.reason);
}

auto fields(Is<TextureLookup> auto& lookup) {
  return std::tie(lookup.name, lookup.found, lookup.reason);
}

auto fields(Is<ImportedModel> auto& imported) {
  auto& model = imported.model;
  return std::tie(model.format, model.mesh, model.materials, model.textures, model.parts,
                  model.nodes, model.missing_textures, model.notes, model.stated, model.loaded,
                  model.declared, imported.files, imported.absent, imported.material_folders,
                  imported.lookups, imported.libraries, imported.hashes, imported.sandbox_notes);
}

auto fields(Is<ImportFailure> auto& failure) {
  return std::tie(failure.found, failure.remedy);
}

auto fields(Is<CacheIndex> auto& index) {
  return std::tie(index.importer, index.root, index.folder, index.states_of_libraries);
}

template <class A, class T>
requires requires(T& record) {
  fields(record);
}
void visit(A& archive, T& record) {
  std::apply([&archive](auto&... field) { (visit(archive, field), ...); }, fields(record));
}

template <class... T>
void write_block(int fd, BlockKind kind, const T&... values) {
  BlockWriter block(fd, kind);
  Out archive{block};
  (visit(archive, values), ...);
  block.finish();
}

template <class... T>
void read_block(BlockReader& block, BlockKind kind, T&... values) {
  if (block.kind() != kind) reject_imported_data("a block of another type");
  In archive{block};
  (visit(archive, values), ...);
  block.finish();
}

// Checks of a model that the type system does not guarantee.

void check(const TextureUse& use, std::size_t textures) {
  const bool sound = use.texture >= TextureUse::kNone &&
                     (!use.used() || static_cast<std::size_t>(use.texture) < textures) &&
                     use.uv_set <= 1 && use.wrap_u <= Wrap::clamp && use.wrap_v <= Wrap::clamp &&
                     use.filter <= Filter::nearest && use.uv_scale_rotate.allFinite() &&
                     use.uv_offset.allFinite();
  if (!sound) reject_imported_data("a material uses a texture in an impossible way");
}

bool in_unit_range(const Eigen::Vector3f& colour) {
  return (colour.array() >= 0.0F).all() && (colour.array() <= 1.0F).all();
}

void check(const Material& m, std::size_t textures) {
  const bool sound = in_unit_range(m.ambient) && in_unit_range(m.diffuse) &&
                     in_unit_range(m.specular) && m.shininess >= 0.0F && m.shininess <= 128.0F &&
                     m.opacity >= 0.0F && m.opacity <= 1.0F && m.alpha_cutoff >= 0.0F &&
                     m.alpha_cutoff <= 1.0F && std::isfinite(m.normal_scale);
  if (!sound) reject_imported_data("material '" + m.name + "' has an impossible number");
  for (const TextureUse* use :
       {&m.diffuse_texture, &m.specular_texture, &m.alpha_texture, &m.normal_texture}) {
    check(*use, textures);
  }
}

void check(const Texture& texture) {
  const std::uint64_t texels = std::uint64_t{texture.width} * texture.height;
  const bool sound = texture.channels >= 1 && texture.channels <= 4 && texels > 0 &&
                     texels <= texture.texels.size() &&
                     texels * texture.channels == texture.texels.size();
  if (!sound) reject_imported_data("texture '" + texture.name + "' has an impossible size");
}

template <class V>
void check_finite(const std::vector<V>& values, const char* what) {
  const bool finite =
      std::all_of(values.begin(), values.end(), [](const V& v) { return v.allFinite(); });
  if (!finite) reject_imported_data(std::string(what) + " that are not finite");
}

void check(const Mesh& mesh) {
  validate(mesh);
  check_finite(mesh.normals, "normals");
  check_finite(mesh.tangents, "tangents");
  check_finite(mesh.uvs[0], "uvs");
  check_finite(mesh.uvs[1], "uvs");
  check_finite(mesh.colours, "colours");
  if (!mesh.origin_m.allFinite()) reject_imported_data("an origin that is not finite");
  if (mesh.triangles.empty()) reject_imported_data("no triangles");
}

void check(const ModelFrame& declared) {
  const double metres = declared.metres_per_unit.value_or(1.0);
  if (!std::isfinite(metres) || !(metres > 0.0) || declared.up.value_or(Axis::z) > Axis::z) {
    reject_imported_data("an impossible unit or up axis");
  }
}

void check(const std::vector<ModelNode>& nodes) {
  std::vector<std::uint32_t> depths(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0 && nodes[i].parent < i) depths[i] = depths[nodes[i].parent] + 1;
    const bool is_sound =
        (nodes[i].parent < i || i == 0) && depths[i] <= kMaxPartDepth &&
        is_rigid(nodes[i].model_from_node) &&
        nodes[i].model_from_node.matrix().row(3) == Eigen::RowVector4d::UnitW().eval();
    if (!is_sound) reject_imported_data("node '" + nodes[i].name + "' has no place in the tree");
  }
  if (nodes.empty() || nodes[0].parent != 0) reject_imported_data("a model without a root");
}

void check(const Model& model) {
  check(model.declared);
  check(model.mesh);
  if (model.materials.size() < slot_count(model.mesh))
    reject_imported_data("a triangle without a material");
  for (const Material& material : model.materials) check(material, model.textures.size());
  for (const Texture& texture : model.textures) check(texture);
  std::uint64_t end = 0;
  for (const ModelPart& part : model.parts) {
    if (part.first_triangle < end) reject_imported_data("part '" + part.name + "' in another one");
    end = std::uint64_t{part.first_triangle} + part.triangle_count;
    if (end > model.mesh.triangles.size())
      reject_imported_data("part '" + part.name + "' beyond the triangles");
    if (part.node >= model.nodes.size()) reject_imported_data("a part without a node");
  }
  check(model.nodes);
}

void check(const ImportedModel& imported) {
  check(imported.model);
  if (imported.files.empty()) reject_imported_data("no source file");
  if (imported.files.size() != imported.hashes.size())
    reject_imported_data("files without their hashes");
}

}  // namespace

void write_model(int fd, const ImportedModel& imported) {
  write_block(fd, BlockKind::model, imported);
}

ImportedModel read_model(BlockReader& block) {
  ImportedModel imported;
  read_block(block, BlockKind::model, imported);
  check(imported);
  return imported;
}

void write_failure(int fd, const ImportFailure& failure) {
  write_block(fd, BlockKind::failure, failure);
}

ImportFailure read_failure(BlockReader& block) {
  ImportFailure failure;
  read_block(block, BlockKind::failure, failure);
  return failure;
}

void write_cached_file(int fd, const CacheIndex& index, const ImportedModel& imported) {
  write_block(fd, BlockKind::cached_file, index, imported);
}

CachedFile read_cached_file(BlockReader& block) {
  CachedFile cached;
  read_block(block, BlockKind::cached_file, cached.index, cached.imported);
  check(cached.imported);
  if (cached.imported.libraries.size() != cached.index.states_of_libraries.size())
    reject_imported_data("a cache without the states of its libraries");
  return cached;
}

}  // namespace glidar

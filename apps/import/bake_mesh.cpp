// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/bake_mesh.hpp>

#include <import/mesh_part.hpp>
#include <import/part_origins.hpp>

#include <fmt/format.h>

#include <cmath>

namespace glidar::import {
namespace {

template <class T>
void join(std::vector<T>& all, const std::vector<T>& part, std::size_t before, std::size_t added,
          const T& filler) {
  if (all.empty() && part.empty()) return;
  all.resize(before, filler);
  if (part.empty()) {
    all.resize(before + added, filler);
  } else {
    all.insert(all.end(), part.begin(), part.end());
  }
}

void append(Mesh& mesh, Mesh part, std::uint16_t slot) {
  if (mesh.positions_m.empty()) {  // often the only one, and large
    part.origins = std::move(mesh.origins);
    part.origin_m = mesh.origin_m;
    mesh = std::move(part);
    mesh.material_slots.resize(mesh.triangles.size(), slot);
    return;
  }
  const std::size_t before = mesh.positions_m.size();
  const std::size_t added = part.positions_m.size();
  join(mesh.positions_m, part.positions_m, before, added, Eigen::Vector3f::Zero().eval());
  join(mesh.normals, part.normals, before, added, Eigen::Vector3f::UnitZ().eval());
  join(mesh.uvs[0], part.uvs[0], before, added, Eigen::Vector2f::Zero().eval());
  join(mesh.uvs[1], part.uvs[1], before, added, Eigen::Vector2f::Zero().eval());
  join(mesh.tangents, part.tangents, before, added, Eigen::Vector4f(1.0F, 0.0F, 0.0F, 1.0F));
  join(mesh.colours, part.colours, before, added, Eigen::Vector3f::Ones().eval());
  const auto shift = static_cast<std::uint32_t>(before);
  for (const Triangle& t : part.triangles) {
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  mesh.material_slots.resize(mesh.triangles.size(), slot);
}

/// The origin of the vertices that are appended next.
void begin_run(Mesh& mesh, const Eigen::Vector3d& origin_m) {
  if (mesh.origins.empty()) mesh.origin_m = origin_m;
  if (!mesh.origins.empty() && mesh.origins.back().origin_m == origin_m) return;
  mesh.origins.push_back({static_cast<std::uint32_t>(mesh.positions_m.size()),
                          static_cast<std::uint32_t>(mesh.triangles.size()), origin_m});
}

void note(Model& model, std::uint64_t count, const char* text) {
  if (count > 0) model.notes.push_back(fmt::format(fmt::runtime(text), count));
}

void note_repairs(const SourceModel& source, const Repairs& repairs, Model& model) {
  note(model, source.lines_and_points, "{} points and lines are left out");
  note(model, repairs.not_finite, "{} triangles touch coordinates that are not finite: left out");
  note(model, repairs.bad_normals, "{} normals are zero or not finite: recomputed");
  if (!source.stated.vertices) {
    note(model, repairs.unused_vertices, "{} vertices belong to no triangle: left out");
  }
}

/// Single precision in the file or its importer is coarse far from zero and may lose detail.
void note_precision(const Eigen::AlignedBox3d& box, bool is_single, Model& model) {
  if (box.sizes().maxCoeff() == 0.0) {
    model.notes.emplace_back("the model has no extent: all its triangles are at one point");
    return;
  }
  if (!is_single) return;
  const double far = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double step = far * std::ldexp(1.0, -23);
  constexpr double kCoarse = 1e-4;
  if (step > kCoarse * box.sizes().maxCoeff()) {
    model.notes.push_back(
        fmt::format("coordinates up to {:.3g} in single precision step by {:.2g}: finer detail is "
                    "lost; save the "
                    "model nearer to zero",
                    far, step));
  }
}

/// Position and orientation, without scale; the identity's where they are not finite or flat.
Pose frame_of(const Eigen::Matrix4d& model_from_node) {
  Pose frame = Pose::Identity();
  const Eigen::Vector3d position = model_from_node.topRightCorner<3, 1>();
  if (is_within_reach(position)) frame.translation() = position;
  const Eigen::Vector3d x = model_from_node.block<3, 1>(0, 0).stableNormalized();
  const Eigen::Vector3d along_y = model_from_node.block<3, 1>(0, 1).stableNormalized();
  const Eigen::Vector3d z = x.cross(along_y).stableNormalized();
  Pose turned = frame;
  turned.linear() << x, z.cross(x), z;
  return is_rigid(turned) ? turned : frame;
}

/// The nodes above triangles, renumbered.
void keep_nodes(const SourceModel& source, Model& model) {
  const std::vector<SourceNode>& nodes = source.nodes;
  std::vector<std::uint8_t> is_used(nodes.size(), 0);
  is_used[0] = 1;
  for (const ModelPart& part : model.parts) is_used[part.node] |= part.triangle_count > 0 ? 1 : 0;
  for (std::size_t i = nodes.size(); i-- > 0;) is_used[nodes[i].parent] |= is_used[i];
  std::vector<std::uint32_t> renumbered(nodes.size(), 0);
  model.nodes.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    renumbered[i] = static_cast<std::uint32_t>(model.nodes.size());
    if (is_used[i] == 0) continue;
    model.nodes.push_back(
        {nodes[i].name, renumbered[nodes[i].parent], frame_of(nodes[i].model_from_node)});
  }
  for (ModelPart& part : model.parts)
    part.node = is_used[part.node] != 0 ? renumbered[part.node] : 0;
}

}  // namespace

void bake(SourceModel& source, double crease_angle_rad,
          const std::vector<std::uint16_t>& slot_of_material, Model& model) {
  const Eigen::AlignedBox3d box = box_of(source);
  const std::vector<Eigen::Vector3d> origins = part_origins(source, box);
  std::vector<std::size_t> last_use(source.meshes.size(), 0);
  for (std::size_t i = 0; i < source.placed.size(); ++i) last_use[source.placed[i].mesh] = i;
  Repairs repairs;
  Mesh& mesh = model.mesh;
  for (std::size_t i = 0; i < source.placed.size(); ++i) {
    const Placed& placed = source.placed[i];
    SourceMesh& from = source.meshes[placed.mesh];
    const std::uint16_t slot = slot_of_material.at(from.material);
    const TextureUse& normals = model.materials.at(slot).normal_texture;
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    Mesh part = make_part(
        from, placed, origins[i],
        {crease_angle_rad, normals.used(), normals.uv_set, last_use[placed.mesh] == i}, repairs);
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    begin_run(mesh, origins[i]);
    append(mesh, std::move(part), slot);
    model.parts.push_back({placed.name, first, count, placed.node});
  }
  keep_nodes(source, model);
  note_repairs(source, repairs, model);
  if (mesh.triangles.empty()) {
    throw Refusal{fmt::format("all {} triangles touch coordinates that are not finite (NaN or "
                              "infinity)",
                              repairs.not_finite),
                  "repair the file"};
  }
  if (mesh.origins.size() == 1) mesh.origins.clear();
  note_precision(box, source.is_single_precision, model);
  if (model.materials.size() == 1) mesh.material_slots.clear();
  model.stated = source.stated;
  model.loaded = {source.used_vertices, repairs.whole_faces, source.placed.size(), bounds(mesh)};
}

}  // namespace glidar::import

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

void append(Mesh& mesh, const Mesh& part, std::uint16_t slot) {
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

void note_repairs(const Walk& walk, const Repairs& repairs, Model& model) {
  note(model, walk.lines_and_points, "{} points and lines are left out");
  note(model, repairs.not_finite, "{} triangles touch coordinates that are not finite: left out");
  note(model, repairs.bad_normals, "{} normals are zero or not finite: recomputed");
  note(model, repairs.unused_vertices, "{} vertices belong to no triangle: left out");
  note(model, walk.skinned, "{} meshes have a skeleton: shown in their rest pose");
}

/// Formats store single precision, which is coarse far from zero and may lose detail.
void note_precision(const Eigen::AlignedBox3d& box, Model& model) {
  if (box.sizes().maxCoeff() == 0.0) {
    model.notes.emplace_back("the model has no extent: all its triangles are at one point");
    return;
  }
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

}  // namespace

void bake(const Walk& walk, const BakeOptions& options, Model& model) {
  const std::vector<Eigen::Vector3d> origins = part_origins(walk);
  Repairs repairs;
  Mesh& mesh = model.mesh;
  mesh.triangles.reserve(walk.triangles);
  for (std::size_t i = 0; i < walk.placed.size(); ++i) {
    const Placed& placed = walk.placed[i];
    const std::uint16_t slot = options.slot_of_material.at(material_of(placed));
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    Mesh part = make_part(placed, origins[i], options, options.needs.at(slot), repairs);
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    begin_run(mesh, origins[i]);
    append(mesh, part, slot);
    model.parts.push_back({placed.name, first, count});
  }
  note_repairs(walk, repairs, model);
  if (mesh.triangles.empty()) {
    throw Refusal{fmt::format("all {} triangles touch coordinates that are not finite (NaN or "
                              "infinity)",
                              repairs.not_finite),
                  "repair the file"};
  }
  if (mesh.origins.size() == 1) mesh.origins.clear();
  note_precision(box_of(walk), model);
  if (model.materials.size() == 1) mesh.material_slots.clear();
}

}  // namespace glidar::import

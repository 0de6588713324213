// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/source_model.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/model_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace glidar::import {

Refusal no_triangles(const std::string& instead) {
  return {
      "no triangles" + instead,
      "GLIDAR needs surfaces: name a model with triangles or polygons (of a point cloud, make a "
      "mesh first)"};
}

Material SourceMaterial::white_material() {
  Material white;
  white.diffuse = white.ambient = Eigen::Vector3f::Ones();
  return white;
}

std::uint32_t add_node(std::vector<SourceNode>& nodes, const std::string& name,
                       std::uint32_t parent, const Eigen::Matrix4d& model_from_node) {
  // The path of a part has the names of all nodes above it.
  constexpr std::size_t kMaxName_bytes = 100;
  constexpr std::size_t kMaxPath_bytes = 1000;
  SourceNode& above = nodes.at(parent);
  if (name.empty()) return parent;
  SourceNode node{excerpt(name, kMaxName_bytes), parent, above.depth + 1, model_from_node};
  node.path_bytes = above.path_bytes + node.name.size() + 1;
  if (node.depth > kMaxPartDepth || node.path_bytes > kMaxPath_bytes ||
      nodes.size() >= kMaxRecords) {
    above.has_omitted_parts = true;
    return parent;
  }
  nodes.push_back(std::move(node));
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

void Notes::add(const Note& note) {
  constexpr std::size_t kMost = 50;
  constexpr std::size_t kMostPlaces = 10;
  constexpr std::size_t kLongest = 1000;
  const auto [known, is_new] = numbers_.try_emplace(note.text.substr(0, kLongest), notes_.size());
  if (!is_new) {
    notes_[known->second].count += note.place.empty() ? 0 : note.count;
    return;
  }
  const auto has_place = [](const Note& one) { return !one.place.empty(); };
  const bool is_full = notes_.size() == kMost ||
                       (has_place(note) && std::count_if(notes_.begin(), notes_.end(), has_place) >=
                                               std::ptrdiff_t{kMostPlaces});
  if (is_full) {
    numbers_.erase(known);
    left_out_ += note.count;
    return;
  }
  notes_.push_back({known->first, note.place, note.count});
}

void Notes::add(const std::string& note) {
  add(Note{note, ""});
}

void Notes::add_at(const std::string& place, const std::string& note) {
  add(Note{note, place});
}

void Notes::add(const Notes& others) {
  for (const Note& note : others.notes_) add(note);
  left_out_ += others.left_out_;
}

std::vector<std::string> Notes::texts() const {
  std::vector<std::string> all;
  for (const Note& note : notes_) {
    std::string& text = all.emplace_back(note.place.empty() ? "" : note.place + ": ");
    text += note.text;
    if (note.count > 1) text += fmt::format("; {} more such places", note.count - 1);
  }
  if (left_out_ > 0) all.push_back(fmt::format("and {} more notes", left_out_));
  return all;
}

namespace {

[[noreturn]] void refuse_instances(std::uint64_t most, const char* what) {
  throw Refusal{fmt::format("its tree places more than {} {}", most, what),
                "make the model smaller, or place its parts by a scene file"};
}

}  // namespace

void SourceModel::take_instances(std::size_t count) {
  if (budget.try_take(Budget::instances, count)) return;
  refuse_instances(budget.limit(Budget::instances),
                   "meshes, which is the limit for a file of its size");
}

void SourceModel::place(Placed instance) {
  const SourceMesh& mesh = meshes.at(instance.mesh);
  triangles_ += mesh.triangles.size();
  if (triangles_ > kMaxTriangles) refuse_instances(kMaxTriangles, "triangles");
  is_placed_.resize(meshes.size());
  const bool is_copy = is_placed_[instance.mesh];
  is_placed_[instance.mesh] = true;
  if (is_copy && !budget.try_take(Budget::copies, mesh.triangles.size() + mesh.positions.size())) {
    refuse_instances(budget.limit(Budget::copies),
                     "vertices and triangles in copies of its meshes, which is the limit for a "
                     "file of its size");
  }
  placed.push_back(std::move(instance));
}

void require_triangles(const SourceModel& source) {
  const bool has_some = std::any_of(
      source.placed.begin(), source.placed.end(),
      [&](const Placed& placed) { return !source.meshes.at(placed.mesh).triangles.empty(); });
  if (has_some) return;
  throw no_triangles(source.lines_and_points > 0
                         ? fmt::format(", only {} points and lines", source.lines_and_points)
                         : "");
}

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/face_lists.hpp>

#include <import/polygons.hpp>

#include <algorithm>
#include <utility>

namespace glidar::import {
namespace {

/// The vertices of one mesh: one for each combination of indices that its corners name.
class Vertices {
 public:
  Vertices(const FileLists& lists, std::vector<std::uint32_t>& newest)
      : lists_(lists),
        newest_(newest),
        corners_have_normals_(!lists.faces.normals.empty()),
        corners_have_uvs_(!lists.faces.uvs.empty()) {}

  /// The number in the mesh.
  std::uint32_t of(std::uint32_t corner, std::uint32_t face) {
    const FaceLists& faces = lists_.faces;
    const Key key = {faces.vertices[corner], faces.uvs.empty() ? kNoIndex : faces.uvs[corner],
                     faces.normals.empty() ? kNoIndex : faces.normals[corner], face};
    std::uint32_t same = newest_[key.vertex];
    while (same != kNoIndex && !is_same(keys_[same], key)) same = before_[same];
    if (same != kNoIndex) return same;
    const auto added = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
    before_.push_back(std::exchange(newest_[key.vertex], added));
    return added;
  }

  void copy_to(SourceMesh& mesh) const {
    mesh.positions.reserve(keys_.size());
    for (const Key& key : keys_) mesh.positions.push_back(lists_.positions[key.vertex]);
    copy_normals(mesh);
    copy_uvs(mesh);
    const auto& of_faces = lists_.faces.colours;
    for (const Key& key : keys_) {
      if (!of_faces.empty()) {
        mesh.colours.push_back(of_faces[key.face]);
      } else if (!lists_.colours.empty()) {
        mesh.colours.push_back(lists_.colours[key.vertex]);
      }
    }
  }

  /// Forgets the mesh.
  void clear() {
    for (const Key& key : keys_) newest_[key.vertex] = kNoIndex;
  }

 private:
  struct Key {
    std::uint32_t vertex;
    std::uint32_t uv;
    std::uint32_t normal;
    std::uint32_t face;
  };

  [[nodiscard]] bool is_same(const Key& a, const Key& b) const {
    const auto& colours = lists_.faces.colours;
    return a.uv == b.uv && a.normal == b.normal &&
           (colours.empty() || colours[a.face] == colours[b.face]);
  }

  void copy_normals(SourceMesh& mesh) const {
    if (!corners_have_normals_) {
      for (const Key& key : keys_) {
        if (!lists_.normals.empty()) mesh.normals.push_back(lists_.normals[key.vertex]);
      }
      return;
    }
    const bool any = std::any_of(keys_.begin(), keys_.end(),
                                 [](const Key& key) { return key.normal != kNoIndex; });
    for (std::size_t i = 0; any && i < keys_.size(); ++i) {
      mesh.normals.push_back(keys_[i].normal == kNoIndex ? Eigen::Vector3f::Zero().eval()
                                                         : lists_.corner_normals[keys_[i].normal]);
    }
  }

  void copy_uvs(SourceMesh& mesh) const {
    if (!corners_have_uvs_) {
      for (const Key& key : keys_) {
        if (!lists_.uvs.empty()) mesh.uvs[0].push_back(lists_.uvs[key.vertex]);
      }
      return;
    }
    const bool any =
        std::any_of(keys_.begin(), keys_.end(), [](const Key& key) { return key.uv != kNoIndex; });
    for (std::size_t i = 0; any && i < keys_.size(); ++i) {
      mesh.uvs[0].push_back(keys_[i].uv == kNoIndex ? Eigen::Vector2f::Zero().eval()
                                                    : lists_.corner_uvs[keys_[i].uv]);
    }
  }

  const FileLists& lists_;
  std::vector<std::uint32_t>& newest_;  ///< of each vertex of the file: in this mesh
  bool corners_have_normals_;
  bool corners_have_uvs_;
  std::vector<std::uint32_t> before_;  ///< of each vertex of the mesh: another of the same vertex
  std::vector<Key> keys_;
};

/// The faces of each part, in the order of the file.
std::vector<std::vector<std::uint32_t>> faces_of_parts(const FileLists& lists) {
  std::vector<std::vector<std::uint32_t>> faces(lists.parts.size());
  for (std::uint32_t f = 0; f < lists.faces.size(); ++f) {
    faces[lists.faces.parts.empty() ? 0 : lists.faces.parts[f]].push_back(f);
  }
  return faces;
}

/// Replaces the vertices of these faces by those of the mesh, which gets their values.
void copy_vertices(FileLists& lists, const std::vector<std::uint32_t>& faces,
                   std::vector<std::uint32_t>& newest, bool is_last, SourceMesh& mesh) {
  Vertices vertices(lists, newest);
  for (const std::uint32_t f : faces) {
    for (std::uint32_t c = lists.faces.begin_of(f); c < lists.faces.end_of(f); ++c) {
      lists.faces.vertices[c] = vertices.of(c, f);
    }
  }
  if (is_last) {
    free_memory(lists.faces.uvs);
    free_memory(lists.faces.normals);
  }
  vertices.copy_to(mesh);
  vertices.clear();
}

/// `is_last`: frees the lists.
SourceMesh mesh_of(FileLists& lists, const std::vector<std::uint32_t>& faces,
                   std::vector<std::uint32_t>& newest, bool is_last, PolygonSplitter& polygons) {
  SourceMesh mesh;
  copy_vertices(lists, faces, newest, is_last, mesh);
  if (is_last) {
    FaceLists left = std::move(lists.faces);
    lists = {};
    lists.faces = std::move(left);
  }
  mesh.triangles.reserve(faces.size());
  for (const std::uint32_t f : faces) {
    const std::uint32_t begin = lists.faces.begin_of(f);
    const auto face = std::span(lists.faces.vertices).subspan(begin, lists.faces.end_of(f) - begin);
    polygons.add(mesh, face);
  }
  return mesh;
}

void state_content(const FileLists& lists, SourceModel& source) {
  std::vector<bool> used(lists.positions.size(), false);
  for (const std::uint32_t v : lists.faces.vertices) used[v] = true;
  source.stated.vertices = lists.positions.size();
  source.used_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
  if (!source.stated.faces) source.stated.faces = lists.faces.size();
  for (const Eigen::Vector3d& p : lists.positions) {
    if (p.allFinite()) source.stated.bounds.extend(p);
  }
}

bool is_one_list(const FileLists& lists) {
  return lists.parts.size() == 1 && lists.faces.uvs.empty() && lists.faces.normals.empty() &&
         lists.faces.colours.empty();
}

/// All faces name one list of vertices: it becomes the mesh.
SourceMesh whole_mesh(FileLists& lists, PolygonSplitter& polygons) {
  SourceMesh mesh;
  mesh.positions = std::move(lists.positions);
  mesh.normals = std::move(lists.normals);
  mesh.uvs[0] = std::move(lists.uvs);
  mesh.colours = std::move(lists.colours);
  mesh.triangles.reserve(lists.faces.size());
  const std::span<const std::uint32_t> corners(lists.faces.vertices);
  for (std::size_t f = 0; f < lists.faces.size(); ++f) {
    const std::uint32_t begin = lists.faces.begin_of(f);
    const std::uint32_t end = lists.faces.end_of(f);
    polygons.add(mesh, corners.subspan(begin, end - begin));
  }
  return mesh;
}

}  // namespace

void FaceLists::add(std::span<const std::uint32_t> corners) {
  if (corners.size() != 3 && ends.empty()) {
    for (std::size_t end = 3; end <= vertices.size(); end += 3) {
      ends.push_back(static_cast<std::uint32_t>(end));
    }
  }
  const bool has_ends = !ends.empty() || corners.size() != 3;
  vertices.insert(vertices.end(), corners.begin(), corners.end());
  if (has_ends) ends.push_back(static_cast<std::uint32_t>(vertices.size()));
}

std::uint32_t FaceLists::begin_of(std::size_t face) const {
  if (ends.empty()) return static_cast<std::uint32_t>(3 * face);
  return face == 0 ? 0 : ends[face - 1];
}

std::uint32_t FaceLists::end_of(std::size_t face) const {
  return ends.empty() ? static_cast<std::uint32_t>(3 * face + 3) : ends[face];
}

void add_meshes(FileLists lists, SourceModel& source) {
  if (lists.faces.vertices.size() >= kNoIndex) {
    throw Refusal{"its faces have more than 4294967294 corners", "make the model smaller"};
  }
  state_content(lists, source);
  if (lists.parts.empty()) lists.parts.emplace_back();
  source.nodes = std::move(lists.nodes);
  PolygonSplitter polygons;
  const auto place = [&source](SourceMesh mesh, const FilePart& part) {
    if (mesh.triangles.empty()) return;
    mesh.material = part.material;
    source.meshes.push_back(std::move(mesh));
    source.take_instances(1);
    source.place({source.meshes.size() - 1, Eigen::Matrix4d::Identity(), part.name, part.node});
  };
  if (is_one_list(lists)) {
    const FilePart part = lists.parts[0];
    SourceMesh mesh = whole_mesh(lists, polygons);
    lists = {};
    place(std::move(mesh), part);
  } else {
    std::vector<std::uint32_t> newest(lists.positions.size(), kNoIndex);
    const auto faces = faces_of_parts(lists);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (faces[i].empty()) continue;
      const FilePart part = lists.parts[i];
      const bool is_last = i + 1 == faces.size();
      place(mesh_of(lists, faces[i], newest, is_last, polygons), part);
    }
  }
  polygons.note_intersecting(source);
}

void scale_colours(std::vector<Eigen::Vector3f>& colours) {
  const bool bytes = std::any_of(colours.begin(), colours.end(),
                                 [](const Eigen::Vector3f& c) { return c.maxCoeff() > 1.0F; });
  if (!bytes) return;
  for (Eigen::Vector3f& c : colours) c /= 255.0F;
}

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/input_file.hpp>
#include <glidar/io/model/model.hpp>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glidar::import {

/// What every reader makes of a file, and all that the steps after it know of it: positions in
/// double, in the file's own units and axes.

/// Thrown if a file cannot become a model; the texts become part of the user's error.
struct Refusal {
  std::string found;
  std::string remedy;
};

/// The error for a file without surfaces; `instead`: its content, "" or ", only ...".
Refusal no_triangles(const std::string& instead);

inline constexpr std::uint64_t kMaxTriangles = 100'000'000;  ///< of all instances

/// Frees the memory of a list, which the assignment of an empty one keeps.
template <class List>
void free_memory(List& list) {
  List().swap(list);
}

/// Messages for the user about a file, in their order, limited in number and length.
class Notes {
 public:
  /// Adds a note once.
  void add(const std::string& note);
  /// Adds a note with the first place that it concerns ("line 7") and the number of places.
  void add_at(const std::string& place, const std::string& note);
  void add(const Notes& others);

  [[nodiscard]] std::vector<std::string> texts() const;

 private:
  struct Note {
    std::string text;
    std::string place;        ///< empty: it concerns the file
    std::uint64_t count = 1;  ///< of places
  };
  void add(const Note& note);

  std::vector<Note> notes_;
  std::map<std::string, std::size_t> numbers_;  ///< by text
  std::uint64_t left_out_ = 0;
};

/// A mesh with one material, V vertices, T triangles.
struct SourceMesh {
  std::vector<Eigen::Vector3d> positions;           ///< V
  std::vector<Eigen::Vector3f> normals;             ///< V, of any length; empty: none
  std::vector<Eigen::Vector4f> tangents;            ///< V, w: sign of the bitangent; empty: none
  std::array<std::vector<Eigen::Vector2f>, 2> uvs;  ///< V each, v upwards; empty: none
  std::vector<Eigen::Vector3f> colours;             ///< V, rgb; empty: none
  std::vector<Triangle> triangles;                  ///< T, each corner < V
  /// The first triangle of each face of the file; empty: every triangle is a face.
  std::vector<std::uint32_t> first_of_face;
  std::size_t material = 0;  ///< index into SourceModel::materials
};

/// A reference to a texture in a material of the file.
struct NamedTexture {
  std::string name;           ///< of a file, a key of SourceModel::images, or a data URI
  TextureUse use;             ///< all but the texture's index
  std::optional<float> bump;  ///< of normals: their strength
};

/// What the opacity of a material does.
enum class AlphaMode : std::uint8_t {
  factor,   ///< opacity texture: cut out at 0.5; an opacity below 1 is shown solid, with a note
  opaque,   ///< nothing (glTF's OPAQUE)
  cut_out,  ///< opacity times the diffuse texture's alpha, cut out at `cutoff` (glTF's MASK)
  blend     ///< is shown solid, with a note (glTF's BLEND)
};

struct SourceMaterial {
  /// Name, colours, shininess and opacity; without textures. Without a colour in the file: white.
  Material material = white_material();
  std::optional<NamedTexture> diffuse;
  std::optional<NamedTexture> specular;
  std::optional<NamedTexture> opacity;
  std::optional<NamedTexture> normals;  ///< normal or height map
  AlphaMode alpha = AlphaMode::factor;
  float cutoff = 0.5F;              ///< of AlphaMode::cut_out
  bool uses_diffuse_alpha = false;  ///< of AlphaMode::factor: the diffuse texture is an opacity too

  /// Surfaces without a material, in all formats.
  static Material white_material();
};

/// A node, group or object with a name. The first of a file is the file itself, without one.
struct SourceNode {
  std::string name;
  std::uint32_t parent = 0;  ///< index of an earlier node
  std::uint32_t depth = 0;   ///< below the file
  Eigen::Matrix4d model_from_node = Eigen::Matrix4d::Identity();
  std::size_t path_bytes = 0;      ///< length of the part's name, which has all names above it
  bool has_omitted_parts = false;  ///< nodes below it are no parts, see add_node()
};

/// Adds a node and returns its index. Returns the parent for a node without a name, and where nodes
/// are nested too deeply (kMaxPartDepth, or a path of 1000 bytes) or are more than kMaxRecords.
std::uint32_t add_node(std::vector<SourceNode>& nodes, const std::string& name,
                       std::uint32_t parent,
                       const Eigen::Matrix4d& model_from_node = Eigen::Matrix4d::Identity());

/// An instance of a mesh, parents applied.
struct Placed {
  std::size_t mesh = 0;  ///< index into SourceModel::meshes
  Eigen::Matrix4d model_from_mesh = Eigen::Matrix4d::Identity();
  std::string name;        ///< of the part
  std::uint32_t node = 0;  ///< index into SourceModel::nodes
};

/// An image inside the model file.
struct EmbeddedImage {
  std::vector<std::uint8_t> bytes;  ///< an image file (PNG, JPEG ...), or rgba texels
  std::uint32_t width = 0;          ///< of rgba texels; 0: an image file
  std::uint32_t height = 0;
};

struct SourceModel {
  std::string format;        ///< e.g. "Stanford Polygon Library (PLY)"
  ModelFrame declared = {};  ///< by the file or by the standard of its format
  std::vector<SourceMesh> meshes;
  std::vector<SourceMaterial> materials;  ///< at least one
  std::vector<Placed> placed;             ///< in the order of the model's parts, by place()
  std::vector<SourceNode> nodes = {SourceNode{}};
  std::map<std::string, EmbeddedImage> images;
  std::uint64_t lines_and_points = 0;  ///< left out
  bool is_single_precision = false;    ///< positions or transforms were rounded before
  ModelContent stated = {};  ///< by the file: its lists and headers; none where it states nothing
  /// Vertices of `stated` that faces use; none where `stated` has none.
  std::optional<std::uint64_t> used_vertices;
  Notes notes;
  InputBudget budget{0};  ///< of the file and its companions; counts what small files can multiply

  /// Counts so many further instances. Throws Refusal, before memory is used for them, if they are
  /// too many for the size of the input.
  void take_instances(std::size_t count);

  /// Adds an instance that take_instances() has counted. Throws Refusal if the copies of meshes are
  /// too large for the size of the input.
  void place(Placed instance);

 private:
  std::uint64_t triangles_ = 0;  ///< of all instances
  std::vector<bool> is_placed_;  ///< of each mesh: it has an instance
};

/// Throws Refusal if it has no triangles.
void require_triangles(const SourceModel& source);

}  // namespace glidar::import

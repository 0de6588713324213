// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>

#include <Eigen/Geometry>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

enum class Axis : std::uint8_t { x, y, z };

struct ModelOptions {
  /// Length of one unit of the file; none: as the file declares, else 1.
  std::optional<double> metres_per_unit;
  /// This axis of the file becomes z; none: the one that the file declares, else unchanged axes.
  std::optional<Axis> up;
  bool centre = false;  ///< move the centre of the model's bounding box to the origin
  double crease_angle_rad =
      0.785398163397448310;  ///< generated normals do not smooth sharper edges
  /// More folders that the import process may read; textures outside the model's folder are
  /// searched below them by the last components of their names.
  std::vector<std::filesystem::path> texture_folders;
  bool use_cache = true;
  std::filesystem::path cache_folder;    ///< empty: $XDG_CACHE_HOME/glidar or ~/.cache/glidar
  double time_limit_s = 0.0;             ///< for the import process; 0: 20 s, more for big files
  std::uint64_t memory_limit_bytes = 0;  ///< for the import process; 0: 1 GiB, more for big files

  auto operator<=>(const ModelOptions&) const = default;
};

/// The unit and the up axis of a model's coordinates.
struct ModelFrame {
  std::optional<double> metres_per_unit;
  std::optional<Axis> up;
};

/// A node, group or object of the file with a name, or the file itself. Users call it a part.
struct ModelNode {
  std::string name;          ///< its own; part_names() has the unique path
  std::uint32_t parent = 0;  ///< index of an earlier node
  /// Its position and orientation, without scale: x and y axis of the node, z right-handed.
  Pose model_from_node = Pose::Identity();
};

/// Consecutive triangles that were one mesh of the file.
struct ModelPart {
  std::string name;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t node = 0;  ///< index into Model::nodes
};

/// A texture of the model that could not be used.
struct MissingTexture {
  std::string name;    ///< as in the model
  std::string reason;  ///< not found, outside the model's folder, corrupt, too large ...
};

/// What a file contains, by its own statements or as loaded. No value: it states nothing.
struct ModelContent {
  std::optional<std::uint64_t> vertices;   ///< of the file's own lists
  std::optional<std::uint64_t> faces;      ///< polygons
  std::optional<std::uint64_t> instances;  ///< of its meshes
  Eigen::AlignedBox3d bounds;              ///< of all its vertices, in its own units and axes
};

/// "vertices 4 stated, 3 loaded; ...": where what was loaded differs from what the file states;
/// empty: nowhere. Boxes differ if it is by more than 1e-6 of their size.
std::string content_difference(const ModelContent& stated, const ModelContent& loaded);

/// A loaded model: all its meshes with node transforms applied, in one object frame.
/// Triangles keep the order of a depth-first walk over the file's nodes.
struct Model {
  std::string source;              ///< path or "builtin:NAME"
  std::string hash;                ///< of all files it was read from, hexadecimal; empty: built in
  std::vector<std::string> files;  ///< canonical paths of all files it was read from, itself first
  std::string format;              ///< of the file, e.g. "Stanford Polygon Library (PLY)"
  Mesh mesh;
  std::vector<Material> materials;  ///< slot -> material
  std::vector<Texture> textures;
  std::vector<ModelPart> parts;
  /// Parents first. The first is the file itself, without a name, in the file's own axes.
  std::vector<ModelNode> nodes = {ModelNode{}};
  std::vector<MissingTexture> missing_textures;
  std::vector<std::string> notes;  ///< omitted or repaired parts, in words
  ModelContent stated = {};        ///< by the file
  ModelContent loaded = {};        ///< of what it states, in the same units and axes
  ModelFrame declared = {};        ///< by the file or by the standard of its format
  ModelFrame applied = {};  ///< by load_model(); no unit: 1 was assumed; no up: axes as in the file
  bool from_cache = false;
};

/// Loads a file of any format that Assimp reads, or a built-in model (make_builtin_model()).
/// The importer runs in a separate process (glidar-import) with limits on time and memory, and
/// reads only below the model's folder (in a model package with `model.config`, or with `meshes`
/// and `materials` side by side, below the package's) and the texture folders.
/// Coordinates are those of the file with node transforms. Unit and up axis are those of the
/// options, else those that the file declares: COLLADA (`unit`, `up_axis`; without them 1 m and y),
/// FBX (UnitScaleFactor in cm, UpAxis), 3MF and AMF (`unit`; without it 1 mm; z is up), glTF (1 m
/// and y by its standard); other formats declare nothing, and 1 m and the axes of the file are
/// assumed. The mesh's origin differs from zero only along axes where the model does not contain
/// zero, so that no single-precision coordinate of the file is rounded; parts that are far from
/// each other have origins of their own (Mesh::origins). Normals of STL are those of its facets and
/// count as missing; points and lines are omitted and listed in notes. Missing textures and notes
/// are reported, and progress when it takes over half a second: "loading NAME" with a fraction,
/// negative while unknown. Throws Error: unknown format, corrupt file, no triangles, time or memory
/// limit, import process crashed.
Model load_model(const std::string& source, const ModelOptions& options, const Report& report);

/// Appends the model's mesh, materials and textures to the scene and one instance of it with
/// identity pose and its number in the scene, from 1, as its id; the caller may change both.
/// Returns the instance's index.
std::size_t add_model(Scene& scene, Model model);

/// Scales an instance along its model's own axes: p_world = pose * (scale_x x, scale_y y, scale_z
/// z). Three equal positive factors become Instance::scale. For others the scene gets a scaled copy
/// of the mesh, with the normals of the scaled surface, which instances with equal factors share,
/// and Instance::scale is 1. Negative factors mirror: the winding of such a copy is reversed where
/// the front of its triangles would be inside. A scaled mesh without instances is removed, which
/// changes the indices of meshes after it.
/// Throws Error, and changes nothing, unless all are from kMinScale to kMaxScale without their
/// sign, and the scaled mesh fits single precision.
void set_scale(Scene& scene, std::size_t instance, const Eigen::Vector3d& scale);

/// The factors of set_scale().
Eigen::Vector3d scale_of(const Scene& scene, const Instance& instance);

}  // namespace glidar

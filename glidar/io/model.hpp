// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

enum class Axis : std::uint8_t { x, y, z };

struct ModelOptions {
  double metres_per_unit = 1.0;  ///< what one unit of the file is
  std::optional<Axis> up;        ///< this axis of the file becomes z; none: axes as in the file
  double crease_angle_rad =
      0.785398163397448310;  ///< made normals do not smooth over sharper edges
  bool use_cache = true;
  std::filesystem::path cache_folder;    ///< empty: $XDG_CACHE_HOME/glidar or ~/.cache/glidar
  double time_limit_s = 0.0;             ///< for the import process; 0: 20 s, more for big files
  std::uint64_t memory_limit_bytes = 0;  ///< for the import process; 0: 1 GiB, more for big files
};

/// A run of triangles that was one mesh of the file.
struct ModelPart {
  std::string name;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
};

/// A texture that the model names and that could not be used.
struct MissingTexture {
  std::string name;    ///< as the model spells it
  std::string reason;  ///< not found, outside the model's folder, broken, too large ...
};

/// One loaded model: all its meshes with node transforms applied, in one object frame.
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
  std::vector<MissingTexture> missing_textures;
  std::vector<std::string> notes;  ///< what was left out or repaired, in words
  bool from_cache = false;
};

/// Loads a file of any format that Assimp reads, or "builtin:asteroid|sphere|box|torus|plane".
/// The importer runs in a process of its own (glidar-import) with limits on time and memory, and
/// reads only below the model's folder (in a model package with `model.config`, or with `meshes`
/// and `materials` side by side, below the package's).
/// Coordinates and axes are as the file has them, with node transforms, whichever axis it says is
/// up; COLLADA's unit is applied by the importer, FBX' is not (Model::notes tells it). Then
/// metres_per_unit and up act. The mesh's origin is away from zero only along axes on which the
/// model is, so that no single-precision coordinate of the file is rounded. Normals of STL are its
/// facets' and count as missing; points and lines are left out and told in notes.
/// Missing textures and notes are told through report, and progress when it takes over half a
/// second: "loading NAME" with a fraction, negative while unknown.
/// Throws Error: unknown format, broken, no triangles, time or memory limit, import process
/// crashed.
Model load_model(const std::string& source, const ModelOptions& options, const Report& report);

/// Appends the model's mesh, materials and textures to the scene and one instance of it with
/// identity pose, which the caller may change. Returns the instance's index.
std::size_t add_model(Scene& scene, Model model);

}  // namespace glidar

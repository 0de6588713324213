// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/mesh_check.hpp>
#include <glidar/io/model/model.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Orientation of the triangles of a model.
enum class Winding : std::uint8_t {
  outward,       ///< closed, all fronts outside
  inward,        ///< closed, all fronts inside
  inconsistent,  ///< neighbours have opposite orientations
  undecided      ///< consistent, but not closed: inside and outside are undefined
};

/// "outward", "inward", "inconsistent", "undecided".
std::string to_string(Winding winding);

struct MaterialSummary {
  std::string name;
  std::uint64_t triangles = 0;
  float reflectance = 0.0F;  ///< luminance of the diffuse colour; textures and colours multiply it
  std::string diffuse_texture;  ///< names; empty: none
  std::string specular_texture;
  std::string normal_texture;  ///< normal map, or converted height map
  std::string alpha_texture;
  bool cut_out = false;  ///< transparent where its opacity is below alpha_cutoff
};

struct TextureSummary {
  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;
};

/// The data that `glidar info` prints about a model. Lengths in metres after scaling.
struct ModelReport {
  std::string source;
  std::string format;
  std::string hash;  ///< of all its files; empty: built in
  bool from_cache = false;
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::vector<ModelPart> parts;
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d max_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  MeshCheck check;
  bool closed = false;  ///< no edge with only one triangle
  Winding winding = Winding::undecided;
  std::vector<MaterialSummary> materials;
  std::vector<TextureSummary> textures;  ///< found
  std::vector<MissingTexture> missing_textures;
  ModelContent stated;                  ///< by the file, in its own units
  ModelContent loaded;                  ///< of that
  std::vector<std::string> notes;       ///< omitted parts with NaN, points and lines; repairs
  double metres_per_unit = 1.0;         ///< applied
  std::optional<double> unit_declared;  ///< metres, by the file
  std::string unit_guess;  ///< a sentence: the source of the unit or, if assumed, a guess
  std::string up;          ///< a sentence: which axis became z, and the source of that
};

ModelReport inspect(const Model& model);

/// A guess from the longest side of the bounding box, because scenes have sizes of centimetres to a
/// hundred metres: from 0.02 to 200 metres are plausible; up to 200,000 it may be terrain or an
/// object in millimetres; otherwise no unit is likely.
std::string guess_unit(double longest_side_m);

}  // namespace glidar

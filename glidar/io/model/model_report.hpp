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

/// Which way the triangles of a model face.
enum class Winding : std::uint8_t {
  outward,       ///< closed, all fronts outside
  inward,        ///< closed, all fronts inside
  inconsistent,  ///< neighbours turn opposite ways
  undecided      ///< consistent, but not closed: no outside to compare with
};

/// "outward", "inward", "inconsistent", "undecided".
std::string to_string(Winding winding);

struct MaterialSummary {
  std::string name;
  std::uint64_t triangles = 0;
  std::string diffuse_texture;  ///< names; empty: none
  std::string specular_texture;
  std::string normal_texture;  ///< normal map, or height map turned into one
  std::string alpha_texture;
  bool cut_out = false;  ///< lets rays through where its opacity is below alpha_cutoff
};

struct TextureSummary {
  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;
};

/// What `glidar info` tells of a model, as plain data. Lengths in metres after scaling.
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
  std::vector<std::string> notes;       ///< NaN parts, points and lines left out, repairs
  double metres_per_unit = 1.0;         ///< applied
  std::optional<double> unit_declared;  ///< metres, by the file
  std::string unit_guess;  ///< a sentence: where the unit is from or, where it is assumed, a guess
  std::string up;          ///< a sentence: which axis became z, and who said so
};

ModelReport inspect(const Model& model);

/// A guess from the longest side of the box, as sensors see things of centimetres to a hundred
/// metres: from 0.02 to 200 it may well be metres; from there to 200,000 millimetres are likely;
/// below 0.02 and above nothing is likely.
std::string guess_unit(double longest_side_m);

}  // namespace glidar

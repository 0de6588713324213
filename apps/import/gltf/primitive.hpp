// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/accessors.hpp>
#include <import/gltf/materials.hpp>
#include <import/source_model.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace glidar::import::gltf {

/// What the reading of primitives needs.
/// Modes of primitives (glTF 2.0, 5.24.4).
struct Mode {
  enum : std::uint8_t { points, lines, line_loop, line_strip, triangles, strip, fan };
};

struct Context {
  Document& document;
  Buffers& buffers;
  SourceModel& model;
  std::vector<UvSets> uv_sets;  ///< of each material
};

/// The deformation of a mesh at one node.
struct Deformation {
  std::vector<double> weights;          ///< of the morph targets
  std::vector<Eigen::Matrix4d> joints;  ///< scene_from_mesh of each; empty: no skin
};

/// Reads a primitive: triangles, strips or fans (glTF 2.0, 3.7.2), morphed and then skinned (glTF
/// 2.0, 3.7.3.3: the mean of joint times inverse bind matrix by the weights). None if it has points
/// or lines, which are counted, or no positions. Throws Refusal with the path of what is invalid.
std::optional<SourceMesh> read_primitive(Context& context, const Value& primitive,
                                         const Deformation& deformation);

}  // namespace glidar::import::gltf

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace glidar::import {

inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Faces as the lists of a file state them: C corners of F faces.
struct FaceLists {
  std::vector<std::uint32_t> vertices;   ///< C, into the vertices
  std::vector<std::uint32_t> uvs;        ///< C, into FileLists::corner_uvs; empty: none
  std::vector<std::uint32_t> normals;    ///< C, into FileLists::corner_normals; empty: none
  std::vector<Eigen::Vector3f> colours;  ///< F; empty: none
  std::vector<std::uint32_t> ends;       ///< F, the corner after the last; empty: triangles
  std::vector<std::uint32_t> parts;      ///< F, into FileLists::parts; empty: all 0

  /// Adds a face with these vertices.
  void add(std::span<const std::uint32_t> corners);
  [[nodiscard]] std::size_t size() const {
    return ends.empty() ? vertices.size() / 3 : ends.size();
  }
  /// The range of corners of a face.
  [[nodiscard]] std::uint32_t begin_of(std::size_t face) const;
  [[nodiscard]] std::uint32_t end_of(std::size_t face) const;
};

struct FilePart {
  std::string name;
  std::size_t material = 0;
  std::uint32_t node = 0;  ///< index into FileLists::nodes
};

/// The lists of a file.
struct FileLists {
  std::vector<Eigen::Vector3d> positions;       ///< V
  std::vector<Eigen::Vector3f> normals;         ///< V or empty
  std::vector<Eigen::Vector3f> colours;         ///< V or empty
  std::vector<Eigen::Vector2f> uvs;             ///< V or empty
  std::vector<Eigen::Vector2f> corner_uvs;      ///< that FaceLists::uvs names
  std::vector<Eigen::Vector3f> corner_normals;  ///< that FaceLists::normals names
  FaceLists faces;
  std::vector<FilePart> parts;  ///< in the order of the model; empty: one without a name
  std::vector<SourceNode> nodes = {SourceNode{}};  ///< as in SourceModel
};

/// Makes a mesh of each part with faces, places it, and states the content of the lists. All
/// indices must be valid.
void add_meshes(FileLists lists, SourceModel& source);

/// Colours of one file: 0..255 if one of them exceeds 1, else 0..1.
void scale_colours(std::vector<Eigen::Vector3f>& colours);

}  // namespace glidar::import

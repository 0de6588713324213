// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/io/model/model.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Nodes of a file are at most so far below the root; deeper ones are no parts.
inline constexpr std::uint32_t kMaxPartDepth = 64;

/// A part of a model with all parts below it.
struct PartSummary {
  std::string name;    ///< its path
  std::string parent;  ///< empty: the file
  std::vector<std::string> materials;
  std::uint64_t triangles = 0;
  Eigen::AlignedBox3d box_m;                 ///< in the model's frame
  Pose parent_from_part = Pose::Identity();  ///< without scales of the file, metres
};

/// The path of each node, "arm/hand": unique by a suffix, _2, _3 ..., where the file repeats names.
/// That of the file itself is empty.
std::vector<std::string> part_names(const std::vector<ModelNode>& nodes);

/// All parts, parents first.
std::vector<PartSummary> list_parts(const Model& model);

/// Whether the text is like a pattern, in which * replaces any characters, and ? one.
bool matches_pattern(std::string_view pattern, std::string_view text);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/config/material_keys.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Names of sensors of the rig in one key.
struct SensorNames {
  std::vector<std::string> names;  ///< empty: the key is missing
  std::string where;               ///< for errors
};

/// Which sensors see an object.
struct Visibility {
  SensorNames visible_to;
  SensorNames hidden_from;
};

/// What becomes objects of their own.
enum class Split : std::uint8_t { none, parts, materials };

/// What an instance changes of parts of its model.
struct PartOverride {
  std::string selector;    ///< a name or pattern of parts, or "material:" and one of materials
  std::string where;       ///< for errors
  std::string class_name;  ///< empty: that of the instance
  std::optional<std::uint32_t> id;
  std::optional<Pose> parent_from_part;
  Visibility visibility;  ///< a key that is missing: that of the instance
  std::vector<MaterialOverride> materials;
};

/// Keys of one entry of `parts` in scene files.
void describe(PartOverride& part, FieldVisitor& visitor);

/// The key `parts`, in the order of the file.
void visit_parts(FieldVisitor& visitor, std::vector<PartOverride>& parts);

/// The key `split`.
void visit_split(FieldVisitor& visitor, Split& split);

/// The keys `visible_to` and `hidden_from`.
void visit_visibility(FieldVisitor& visitor, Visibility& visibility);

/// The key `materials`: changes by the name of a material, those for "*" first.
void visit_materials(FieldVisitor& visitor, std::vector<MaterialOverride>& changes);

}  // namespace glidar

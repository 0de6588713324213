// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/core/pose.hpp>

namespace glidar {

class FieldVisitor;

/// A pose as a map of a file, in one of several notations.
struct PoseKeys {
  Pose pose = Pose::Identity();
  bool takes_look_at = false;  ///< the pose of a sensor may be given by the point that it looks at
  bool looks_at = false;       ///< it was
};

void describe(PoseKeys& keys, FieldVisitor& visitor);

/// A pose as a nested map that may be absent. Returns whether it is present.
bool visit_pose(FieldVisitor& visitor, const FieldInfo& field, bool is_present, PoseKeys& keys);
bool visit_pose(FieldVisitor& visitor, const FieldInfo& field, bool is_present, Pose& pose);

}  // namespace glidar

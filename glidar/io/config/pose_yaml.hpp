// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/pose.hpp>
#include <glidar/io/config/yaml_reader.hpp>

namespace glidar {

/// world_from_object of {position: ..., orientation | rotation_vector | euler_deg: ...}.
Pose read_pose(const YamlField& field);

/// world_from_sensor: the same, or {look_at: {eye: ..., target: ..., up: ...}}.
Pose read_sensor_pose(const YamlField& field);

}  // namespace glidar

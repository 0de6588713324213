// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace glidar {

/// The kinds of files that have a schema, "sensor", "imu", "scene" and "surfaces", and the parts of
/// scene files that have one: "pose", "motion" and "materials".
std::vector<std::string> schema_names();

/// A JSON Schema (draft 7) of a kind of file, for editors and validators. Beside the standard words
/// it has x-unit, x-allowed and x-default, the words of errors and documentation. Throws Error when
/// the kind has none.
std::string json_schema(const std::string& name);

}  // namespace glidar

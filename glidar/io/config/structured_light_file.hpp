// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/structured_light.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// The camera, projector and patterns of a YAML file (docs/structured-light.md): a setup, or a
/// sensor with a depth_camera of type structured_light. Throws Error with the place in the file.
StructuredLight load_structured_light(const std::filesystem::path& path);

/// The same of a text in YAML or JSON.
StructuredLight parse_structured_light(const std::string& text);

}  // namespace glidar

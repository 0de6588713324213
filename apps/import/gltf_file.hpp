// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace glidar::import {

/// The JSON of a .gltf file, or of the first chunk of a .glb file (glTF 2.0, section 4.4).
std::string_view gltf_json(std::string_view file);

/// The raw chunks of a .glb file after its JSON; empty for a .gltf file.
std::string_view gltf_chunks_after_json(std::string_view file);

/// The data of the binary chunk of a .glb file; empty without one.
std::string_view gltf_binary_chunk(std::string_view file);

/// The file with its JSON replaced.
std::string with_json(std::string_view file, const nlohmann::json& json);

}  // namespace glidar::import

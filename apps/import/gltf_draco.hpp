// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace glidar::import {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// The bytes of the buffer with this index; empty when they cannot be had.
using GltfBuffers = std::function<std::string_view(std::size_t buffer)>;

/// Decodes the meshes that are compressed by KHR_draco_mesh_compression, and changes the JSON as if
/// they had never been compressed: their accessors refer to a new, last buffer without `uri`, whose
/// content is returned. Empty: no mesh is compressed.
/// Assimp 5.2 decodes them too, but fails for indices of 32 bits.
/// Throws Refusal when the data cannot be decoded, nlohmann::json::exception when the JSON is not
/// that of a glTF file.
std::string decode_draco(nlohmann::json& gltf, const GltfBuffers& buffers);

}  // namespace glidar::import

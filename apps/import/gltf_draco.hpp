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

/// The bytes of the buffer with this index; empty if not available.
using GltfBuffers = std::function<std::string_view(std::size_t buffer)>;

/// Decodes meshes with KHR_draco_mesh_compression and changes the JSON to the uncompressed form:
/// their accessors refer to a new, last buffer without `uri`, whose content is returned. Empty: no
/// mesh is compressed. Assimp 5.2 decodes them too, but fails for 32-bit indices.
/// Throws Refusal for invalid data, nlohmann::json::exception for JSON that is not glTF.
std::string decode_draco(nlohmann::json& gltf, const GltfBuffers& buffers);

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/accessors.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace glidar::import::gltf {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// A decompressed primitive.
struct DracoMesh {
  std::vector<std::uint32_t> corners;     ///< three of each triangle
  std::map<std::string, Accessor> views;  ///< of the compressed attributes, by name
  std::map<std::string, std::string> bytes;
};

/// Decompresses a primitive with KHR_draco_mesh_compression. Its attributes have the component
/// types of their accessors, without limits: compression moves them. Notes sizes that the accessors
/// state wrongly. Throws Refusal for invalid data.
DracoMesh decode_draco(Document& document, Buffers& buffers, const Value& primitive);

}  // namespace glidar::import::gltf

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/document.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar::import::gltf {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// What a compressed buffer view states of its content.
struct MeshoptLayout {
  std::string mode;        ///< ATTRIBUTES, TRIANGLES or INDICES
  std::size_t count = 0;   ///< elements
  std::size_t stride = 0;  ///< bytes of each
};

/// Checks the counts against the size of the compressed data; `extension` is the view's
/// EXT_meshopt_compression.
MeshoptLayout meshopt_layout(const Value& extension, std::size_t compressed_bytes);

/// The decompressed content, of layout.count * layout.stride bytes.
std::string decode_meshopt(const Value& extension, const MeshoptLayout& layout,
                           std::string_view compressed);

}  // namespace glidar::import::gltf

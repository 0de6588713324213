// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/document.hpp>

#include <string>
#include <string_view>

namespace glidar::import::gltf {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// The decompressed content of a buffer view; `extension` is its EXT_meshopt_compression, `bytes`
/// its compressed data. Checks the counts against the size of the data before it allocates memory.
std::string decode_meshopt(const Value& extension, std::string_view bytes);

}  // namespace glidar::import::gltf

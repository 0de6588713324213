// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/buffers.hpp>
#include <import/source_model.hpp>

#include <string_view>

namespace glidar::import::gltf {

/// Whether a file is glTF, by its lower-case extension or its first bytes.
bool is_gltf(std::string_view extension, std::string_view first_bytes);

/// Reads a .gltf or .glb file of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2.0.1). Each
/// statement of the file is used, named in a note, or refused with its JSON path (Refusal). `open`
/// gives the bytes of buffers in files of their own.
SourceModel read_gltf(std::string_view file, OpenFile open);

}  // namespace glidar::import::gltf

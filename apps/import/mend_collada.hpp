// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidar::import {

/// A COLLADA document (1.4.1 and 1.5) in a form that Assimp reads correctly: in UTF-8, without
/// prefixes of namespaces and white space around numbers; without cameras, lights and textures
/// without a file, for which Assimp refuses the whole document; tangents only beside binormals;
/// strips and fans as triangles. Notes what is left out. Throws Refusal for malformed XML and for
/// what Assimp would read wrongly: polygons with holes, skewed nodes, references to other
/// documents.
std::string mend_collada(std::string_view document, std::vector<std::string>& notes);

}  // namespace glidar::import

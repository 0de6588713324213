// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <pugixml.hpp>

namespace glidar::import {

/// Changes a COLLADA document (1.4.1 and 1.5), parsed without white space around numbers, to a form
/// that Assimp reads correctly: without prefixes of namespaces; without cameras, lights and
/// textures without a file, for which Assimp refuses the whole document; tangents only beside
/// binormals; strips and fans as triangles. Notes what is left out. Throws Refusal for what Assimp
/// would read wrongly: polygons with holes, skewed nodes, references to other documents.
void mend_collada(pugi::xml_document& document, Notes& notes);

}  // namespace glidar::import

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/document.hpp>

namespace glidar::import::gltf {

/// Throws Refusal for a required extension that GLIDAR does not read.
void check_extensions(const Document& document);

/// Adds notes on everything in the document that GLIDAR does not use: extensions, members that the
/// standard does not define, animations, cameras. `extras`, names and hints for drawing
/// (`bufferView.target`, `minFilter`, `skeleton`) state nothing that is measured.
void note_unused(Document& document);

}  // namespace glidar::import::gltf

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes the frame's Woods2016Framebuffer byte by byte as 8-bit RGBA; the file's description
/// contains its clipping planes. Throws Error when the frame was not read from such a framebuffer.
void write_woods2016_png(const CloudFile& job, AtomicFile& file);

}  // namespace glidar

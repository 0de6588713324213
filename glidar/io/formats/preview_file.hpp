// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes a preview: coloured depth and grey intensity, each with its colour scale.
void write_preview(const CloudFile& job, AtomicFile& file);

}  // namespace glidar

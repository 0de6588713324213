// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes depth in metres as TIFF with one 32-bit float per pixel, NaN for no return.
void write_depth_tiff(const CloudFile& job, AtomicFile& file);

}  // namespace glidar

// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

/// Writes an uncompressed NumPy archive: every column as (rows, cols) or (rows, cols, components),
/// poses 4x4 (world_from_sensor, world_from_cloud, world_from_instance (k, 4, 4)), stamp_ns, seed.
void write_npz(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
